// SPDX-License-Identifier: MIT
// `shutter blur` of pictures that `render` and other programs write.
#include "engine/image/image.h"
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "tests/cli/cli_fixture.h"

#include <fmt/format.h>

#include <functional>
#include <limits>
#include <utility>

namespace shutter::cli {

namespace {

// The camera moves and turns from the first frame to the second.
constexpr const char* kFirst =
    R"("position": [-0.6, 1.2, 2.3], "rotation": [0, 0, 0, 1], "fieldOfView": 40)";
constexpr const char* kSecond = R"("position": [-0.5, 1.2, 2.3],
    "rotation": [0, 0.0199986667, 0, 0.9998000067], "fieldOfView": 40)";

class Blur : public Cli {
  protected:
    void SetUp() override {
        requireDevice();
        writeFile(
            "flight.json",
            fmt::format(
                R"({{"version": 1, "fps": 24, "keys": [{{"time": 0, {}}}, {{"time": {}, {}}}]}})",
                kFirst,
                1.0 / 24.0,
                kSecond
            )
        );
        const std::string two =
            fmt::format(R"({{"frame": 0, {}}}, {{"frame": 1, {}}}]}})", kFirst, kSecond);
        writeFile("two.json", R"({"cameras": [)" + two);
        writeFile(
            "three.json", fmt::format(R"({{"cameras": [{{"frame": -1, {}}}, )", kFirst) + two
        );
    }

    /// Frames 0 and 1 of the flight.
    void render(const std::string& method, const std::string& out) const {
        expectSuccess(renderVase(
            {"--flythrough",
             "flight.json",
             "--shutter-angle",
             "180",
             "--method",
             method,
             "--aov",
             "motion,depth,mesh_id",
             "--out",
             out}
        ));
    }

    [[nodiscard]] static Arguments blur(const Arguments& files, const Arguments& more) {
        return join(join({"blur"}, files), join(kOnSoftware, more));
    }

    /// Blurs frame 1 of s_%d.exr.
    [[nodiscard]] static Arguments blurOne(const Arguments& more) {
        return blur({"s_1.exr", "s_1.motion.exr", "s_1.depth.exr"}, more);
    }

    [[nodiscard]] image::Image read(const std::string& name) const {
        auto picture = io::readImage(path(name));
        EXPECT_TRUE(picture.ok()) << (picture.ok() ? "" : picture.error().message);
        return picture.ok() ? picture.value() : image::Image{};
    }

    /// Writes a picture of the size of `like` with other channels.
    void write(
        const std::string& name,
        const image::Image& like,
        std::vector<std::string> channels,
        const std::function<float(uint32_t x, uint32_t y, uint32_t c)>& value
    ) const {
        image::Image picture(like.width, like.height, uint32_t(channels.size()));
        picture.channelNames = std::move(channels);
        for (uint32_t y = 0; y < picture.height; ++y)
            for (uint32_t x = 0; x < picture.width; ++x)
                for (uint32_t c = 0; c < picture.channels; ++c)
                    picture.at(x, y, c) = value(x, y, c);
        ASSERT_TRUE(io::writeImage(path(name), picture).ok());
    }

    void expectNear(const std::string& a, const std::string& b, double decibels) const {
        EXPECT_GE(image::computePsnr(read(a), read(b)), decibels) << a << " " << b;
    }
};

} // namespace

TEST_F(Blur, PicturesThatRenderWroteBecomeThePicturesThatItDraws) {
    render("sharp", "s_%d.exr");
    render("gather", "g_%d.exr");
    render("resolved", "r_%d.exr");
    EXPECT_LT(image::computePsnr(read("s_1.exr"), read("g_1.exr")), 40.0)
        << "hardly anything moves";
    expectSuccess(blurOne({"--out", "blurred.exr"}));
    EXPECT_EQ(read("blurred.exr").pixels, read("g_1.exr").pixels);
    EXPECT_EQ(read("blurred.exr").channelNames, (Arguments{"R", "G", "B"}));
    const Arguments sequence = blur(
        {"s_%d.exr", "s_%d.motion.exr", "s_%d.depth.exr"},
        {"--frames", "0:1", "--camera", "three.json", "--out", "b_%d.exr"}
    );
    expectSuccess(join(sequence, {"--ids", "s_%d.mesh_id.exr"}));
    expectNear("b_1.exr", "r_1.exr", 50.0);
    expectSuccess(sequence); // which is not the same pictures
    expectNear("b_1.exr", "r_1.exr", 40.0);
}

TEST_F(Blur, FramesThatAreCompleteAreSkippedAndAStoppedRunEndsWithTheSameBits) {
    render("sharp", "s_%d.exr");
    const Arguments sequence = blur(
        {"s_%d.exr", "s_%d.motion.exr", "s_%d.depth.exr"},
        {"--frames", "0:1", "--camera", "three.json", "--out", "b_%d.exr"}
    );
    expectSuccess(sequence);
    const std::string last = readFile("b_1.exr");
    fs::remove(path("b_1.exr"));
    expectPrinted(sequence, {"b_%d.exr: 1 of 2 frames are complete on disk and skipped"});
    EXPECT_EQ(readFile("b_1.exr"), last);
    EXPECT_EQ(expectSuccess(join(sequence, {"--restart"})).out, "");
}

TEST_F(Blur, VectorsAndDepthOfOtherProgramsGiveTheSamePicture) {
    render("sharp", "s_%d.exr");
    expectSuccess(blurOne({"--out", "own.exr"}));
    const image::Image color = read("s_1.exr");
    const image::Image motion = read("s_1.motion.exr");
    const image::Image depth = read("s_1.depth.exr");
    // Half of the motion between two frames is exposed. Cycles' vectors lead to the frame before.
    const auto layer = [&](uint32_t x, uint32_t y, uint32_t c) {
        if (c < 4)
            return color.at(x, y, c < 3 ? c : 1); // what is blurred as green
        if (c == 4)
            return depth.at(x, y, 0);
        const float own = c < 7 ? 2.0f * motion.at(x, y, c - 5) : 0.0f;
        return c == 5 ? -own : own;
    };
    write(
        "cycles.exr",
        color,
        {"View.Combined.R",
         "View.Combined.G",
         "View.Combined.B",
         "View.Combined.A",
         "View.Depth.Z",
         "View.Vector.X",
         "View.Vector.Y",
         "View.Vector.Z",
         "View.Vector.W"},
        layer
    );
    expectSuccess(blur({"cycles.exr", "cycles.exr", "cycles.exr"}, {"--out", "from_cycles.exr"}));
    EXPECT_EQ(read("from_cycles.exr").channels, 4u);
    write("nuke.exr", color, {"backward.u", "backward.v", "depth.Z"}, [&](auto x, auto y, auto c) {
        if (c == 2)
            return 1.0f / depth.at(x, y, 0);
        return (c == 0 ? -2.0f : 2.0f) * motion.at(x, y, c);
    });
    expectSuccess(
        blur({"s_1.exr", "nuke.exr", "nuke.exr"}, {"--depth", "inverse", "--out", "from_nuke.exr"})
    );
    // Texture coordinates back in time, and a depth buffer whose far plane is infinite.
    write("engine.exr", color, {"R", "G", "Z"}, [&](auto x, auto y, auto c) {
        if (c == 2)
            return depth.at(x, y, 0) < 1.0e9f ? 0.1f / depth.at(x, y, 0) : 0.0f;
        return -2.0f * motion.at(x, y, c) / (c == 0 ? 64.0f : 36.0f);
    });
    expectSuccess(blur(
        {"s_1.exr", "engine.exr", "engine.exr"},
        {"--vectors",
         "previous",
         "--motion-scale",
         "-64,-36",
         "--depth",
         "reversed",
         "--out",
         "from_engine.exr"}
    ));
    const image::Image own = read("own.exr");
    for (const char* name : {"from_cycles.exr", "from_nuke.exr", "from_engine.exr"}) {
        const image::Image other = read(name);
        for (uint32_t i = 0; i < own.width * own.height; ++i)
            for (uint32_t c = 0; c < 3; ++c)
                ASSERT_NEAR(
                    other.pixels[i * other.channels + c], own.pixels[i * own.channels + c], 2.0e-3f
                ) << name;
    }
    const image::Image cycles = read("from_cycles.exr");
    for (size_t i = 3; i < cycles.pixels.size(); i += 4)
        ASSERT_EQ(cycles.pixels[i], cycles.pixels[i - 2]) << "alpha is blurred as colours are";
}

TEST_F(Blur, WhatPicturesLackAndBadFilesAreNamedBeforeAnythingIsWritten) {
    render("sharp", "s_%d.exr");
    const image::Image color = read("s_1.exr");
    writeFile(
        "flat.json",
        R"({"cameras": [{"viewFromWorld": [0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,1], "fieldOfView": 9}]})"
    );
    writeFile("bad.json", R"({"cameras": [{"frame": 1, "position": [0, 0]}]})");
    write("nan.exr", color, {"motion.x", "motion.y"}, [](auto x, auto y, auto c) {
        const bool isNan = x == 3 && y == 2 && c == 1;
        return isNan ? std::numeric_limits<float>::quiet_NaN() : 0.0f;
    });
    write("small.exr", image::Image(8, 8, 1), {"Z"}, [](auto, auto, auto) { return 1.0f; });
    write("pair.exr", color, {"R", "G"}, [](auto, auto, auto) { return 0.0f; });
    write("two.exr", color, {"a.Z", "b.Z"}, [](auto, auto, auto) { return 1.0f; });
    const auto one = [](const Arguments& more) { return blurOne(join({"--out", "b.exr"}, more)); };
    const auto of = [](const Arguments& files) { return blur(files, {"--out", "b.exr"}); };
    const std::string motion = "s_1.motion.exr";
    const std::string depth = "s_1.depth.exr";
    expectRefusals({
        {blurOne({}), kUsage, {"--out"}},
        {blurOne({"--out", "s_1.exr"}), kUsage, {"--out 's_1.exr' is one of the pictures"}},
        {blurOne({"--out", "b.tiff"}), kUsage, {"--out", ".tiff"}},
        {blurOne({"--out", "b_%d.exr"}), kUsage, {"--frames"}},
        {one({"--frames", "1:2"}), kUsage, {"--out 'b.exr' needs a frame number"}},
        {one({"--method", "hybrid"}), kUsage, {"hybrid needs what lies behind", "gather"}},
        {one({"--method", "truth"}), kUsage, {"truth draws from the scene", "gather"}},
        {one({"--method", "resolved"}), kUsage, {"resolved needs --camera"}},
        {one({"--vectors", "up"}), kUsage, {"--vectors", "blender"}},
        {one({"--motion-scale", "0,1"}), kUsage, {"--motion-scale '0,1'"}},
        {one({"--shutter-angle", "0"}), kUsage, {"--shutter-angle 0"}},
        {of({"none.exr", motion, depth}), kFailed, {"none.exr"}},
        {of({"flight.json", motion, depth}), kFailed, {"flight.json"}},
        {of({"s_1.exr", motion, motion}), kFailed, {motion, "no channels Z", "motion.x, motion.y"}},
        {of({"s_1.exr", depth, depth}), kFailed, {depth, "no channels motion.x"}},
        {one({"--vectors", "blender"}), kFailed, {motion, "no channels Vector.X"}},
        {of({"s_1.exr", "pair.exr", depth}), kFailed, {"pair.exr", "--vectors", "R, G"}},
        {of({"s_1.exr", "nan.exr", depth}), kFailed, {"nan.exr", "motion.y is NaN at pixel 3, 2"}},
        {of({"s_1.exr", motion, "small.exr"}), kFailed, {"small.exr", "8 x 8", "64 x 36"}},
        {of({"s_1.exr", motion, "two.exr"}), kFailed, {"two.exr", "a.Z and b.Z"}},
        {one({"--camera", "none.json"}), kFailed, {"none.json"}},
        {one({"--camera", "flat.json"}), kFailed, {"flat.json:1: cameras[0]", "singular"}},
        {one({"--camera", "bad.json"}), kFailed, {"bad.json:1: cameras[0].position"}},
        {one({"--camera", "two.json", "--frames", "0:0"}),
         kFailed,
         {"two.json", "camera of frame -1 is missing, which the exposure of frame 0 needs"}},
        {one({"--camera", "two.json", "--frames", "1:1", "--phase", "start"}),
         kFailed,
         {"camera of frame 2 is missing, which the exposure of frame 1 needs"}},
        {one({"--camera", "two.json", "--frames", "7:7"}),
         kFailed,
         {"camera of frame 7", "--frames"}},
        {one({"--camera", "two.json", "--method", "rosado2007"}), kFailed, {"of frame -1"}},
    });
}

} // namespace shutter::cli
