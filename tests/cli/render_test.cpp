// SPDX-License-Identifier: MIT
#include "engine/image/image.h"
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "tests/cli/cli_fixture.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace shutter::cli {

namespace {

const std::vector<std::string> kMethods = {
    "sharp",
    "gather",
    "hybrid",
    "accumulate",
    "truth",
    "own_velocity",
    "mcguire2012",
    "guertin2014",
    "jimenez2014"};

class CliRender : public Cli {
  protected:
    void SetUp() override { requireDevice(); }

    [[nodiscard]] image::Image read(const std::string& name) const {
        auto picture = io::readImage(path(name));
        EXPECT_TRUE(picture.ok()) << (picture.ok() ? "" : picture.error().message);
        return picture.ok() ? picture.value() : image::Image{};
    }

    /// 64x36, finite, and not one colour all over.
    void expectPicture(const std::string& name) const {
        const image::Image picture = read(name);
        ASSERT_EQ(picture.width, 64u) << name;
        ASSERT_EQ(picture.height, 36u) << name;
        ASSERT_EQ(picture.channels, 3u) << name;
        EXPECT_TRUE(std::all_of(picture.pixels.begin(), picture.pixels.end(), [](float value) {
            return std::isfinite(value);
        })) << name;
        const auto [lowest, highest] =
            std::minmax_element(picture.pixels.begin(), picture.pixels.end());
        EXPECT_GT(*highest - *lowest, 0.1f) << name;
    }

    /// Vulkan's validation layer where it is installed.
    [[nodiscard]] Arguments validated(Arguments arguments) const {
        arguments.push_back("--validate");
        if (run(arguments).err.find("is not installed") != std::string::npos)
            arguments.pop_back();
        return arguments;
    }
};

/// Surroundings of one grey.
image::Image makeGrey(float value) {
    image::Image picture(64, 32, 3);
    for (float& v : picture.pixels)
        v = value;
    return picture;
}

} // namespace

TEST_F(CliRender, EachMethodDrawsAPictureOfItsOwnTheSameEachTimeWithoutAValidationMessage) {
    std::set<std::string> pictures;
    writeFile("sharp.png", "an older picture");
    for (const std::string& method : kMethods) {
        const Arguments drawn = renderVase({"--method", method, "--samples", "8", "--out"});
        expectSuccess(validated(join(drawn, {method + ".png"})));
        expectSuccess(join(drawn, {"again.png"}));
        expectPicture(method + ".png");
        EXPECT_EQ(readFile("again.png"), readFile(method + ".png")) << method;
        pictures.insert(readFile("again.png"));
    }
    EXPECT_EQ(pictures.size(), kMethods.size()) << "no two are alike";
    EXPECT_EQ(listFiles().size(), kMethods.size() + 1); // and no temporary one
}

TEST_F(CliRender, EveryFormatIsWrittenAndWithoutAnExposureNothingIsBlurred) {
    expectSuccess(renderVase({"--out", "sharp.exr"}));
    expectSuccess(renderVase({"--out", "sharp.jpg"}));
    expectSuccess(renderVase({"--method", "hybrid", "--exposure", "0", "--out", "still.exr"}));
    for (const char* file : {"sharp.exr", "sharp.jpg"})
        expectPicture(file);
    EXPECT_EQ(read("still.exr").pixels, read("sharp.exr").pixels);
}

TEST_F(CliRender, OutputsThatAreLinksStayLinksAndKeepPermissions) {
    fs::create_directory(path("store"));
    for (const auto& [link, real] :
         {std::pair{"a.png", "store/a.png"},
          {"a.depth.exr", "store/depth.exr"},
          {"s.json", "store/s.json"}}) {
        writeFile(real, "old");
        fs::permissions(path(real), fs::perms(0664));
        fs::create_symlink(real, path(link));
    }
    const std::set<std::string> before = listFiles();
    expectSuccess(renderVase({"--out", "a.png", "--aov", "depth", "--stats", "s.json"}));
    EXPECT_EQ(listFiles(), before);
    for (const char* link : {"a.png", "a.depth.exr", "s.json"}) {
        EXPECT_TRUE(fs::is_symlink(path(link))) << link;
        EXPECT_NE(readFile(link), "old") << link;
        EXPECT_EQ(fs::status(path(link)).permissions(), fs::perms(0664)) << link;
    }
}

TEST_F(CliRender, StatisticsOnStandardOutputFollowWhatWasPrinted) {
    const std::string out =
        expectSuccess(renderVase({"--out", "a.png", "--explain", "--stats", "/dev/stdout"})).out;
    EXPECT_TRUE(out.starts_with("frame at 0 s\n")) << out;
    EXPECT_TRUE(nlohmann::json::accept(out.substr(out.find("\n{") + 1))) << out;
}

TEST_F(CliRender, TheNumberOfSamplesChangesThePicture) {
    expectSuccess(renderVase({"--method", "gather", "--out", "own.png"}));
    expectSuccess(renderVase({"--method", "gather", "--samples", "3", "--out", "three.png"}));
    EXPECT_NE(readFile("three.png"), readFile("own.png"));
}

TEST_F(CliRender, AllIntermediatesLieBesideThePicture) {
    expectSuccess(renderVase({"--method", "hybrid", "--out", "a.png", "--aov", "all"}));
    const std::set<std::string> expected = {
        "a.png",
        "a.cost.exr",
        "a.depth.exr",
        "a.edge.exr",
        "a.mask.exr",
        "a.mesh_id.exr",
        "a.motion.exr",
        "a.normal.exr",
        "a.reveal.exr",
        "a.reveal_motion.exr",
        "a.tile_max.exr",
        "a.tiles.exr"};
    EXPECT_EQ(listFiles(), expected);
    const image::Image motion = read("a.motion.exr");
    EXPECT_EQ(motion.width, 64u);
    EXPECT_EQ(motion.channels, 2u);
    // 38 px of 1280 to the right, 14 of 720 down, at the vase; the wall is static.
    float furthest = 0.0f;
    for (uint32_t y = 0; y < motion.height; ++y)
        for (uint32_t x = 0; x < motion.width; ++x)
            furthest = std::max(furthest, motion.at(x, y, 0));
    EXPECT_NEAR(furthest, 38.0f / 20.0f, 0.2f);
    EXPECT_EQ(motion.at(0, 0, 0), 0.0f);
}

TEST_F(CliRender, EveryMethodGivesTheIntermediatesItHas) {
    for (const std::string method : {"sharp", "accumulate"}) {
        const Arguments more = {"--method", method, "--samples", "2", "--aov", "all", "--out"};
        expectSuccess(renderVase(join(more, {method + ".exr"})));
        EXPECT_TRUE(listFiles().contains(method + ".mesh_id.exr"));
    }
    EXPECT_EQ(read("sharp.depth.exr").pixels, read("accumulate.depth.exr").pixels);
    expectSuccess(renderVase({"--method", "guertin2014", "--out", "g.exr", "--aov", "all"}));
    EXPECT_EQ(read("g.tiles.exr").width, 2u); // 64 px in tiles of 40
    EXPECT_EQ(read("g.variance.exr").width, 2u);
    EXPECT_FALSE(listFiles().contains("g.mask.exr"));
}

TEST_F(CliRender, AnIntermediateOfABlurThatDidNotRunIsReportedMissing) {
    expectWarned(
        renderVase({"--method", "hybrid", "--exposure", "0", "--out", "a.png", "--aov", "mask"}),
        "--aov mask is not written, because motion blur was skipped: the exposure is 0\n"
    );
    // A single picture has the raster of the frame before it.
    expectWarned(
        renderVase({"--method", "resolved", "--out", "b.png", "--aov", "last,second"}),
        "--aov second is not written, because the setting secondRaster is off\n"
    );
    EXPECT_EQ(listFiles(), (std::set<std::string>{"a.png", "b.last.exr", "b.png"}));
}

TEST_F(CliRender, StatisticsAreJsonWithTheDocumentedKeys) {
    expectSuccess(
        renderVase({"--method", "resolved", "--out", "a.png", "--stats", "s.json", "--repeat", "2"})
    );
    const auto json = nlohmann::json::parse(readFile("s.json"));
    for (const char* key :
         {"scene",
          "method",
          "samples",
          "width",
          "height",
          "exposure_s",
          "device",
          "driver",
          "repeat",
          "pictures"})
        EXPECT_TRUE(json.contains(key)) << key;
    EXPECT_EQ(json.at("method"), "resolved");
    EXPECT_EQ(json.at("width"), 64);
    EXPECT_EQ(json.at("repeat"), 2);
    ASSERT_EQ(json.at("pictures").size(), 1u);
    const auto& picture = json.at("pictures").at(0);
    for (const char* key : {"gpu_ms", "cpu_ms", "wall_ms"})
        EXPECT_GT(picture.at(key).get<double>(), 0.0) << key;
    double sum = 0.0;
    for (const auto& pass : picture.at("passes"))
        sum += pass.at("gpu_ms").get<double>();
    EXPECT_NEAR(picture.at("gpu_ms").get<double>(), sum, 1e-9);
    EXPECT_TRUE(picture.at("counters").contains("unresolved samples"));
    expectSuccess(renderVase({"--method", "hybrid", "--out", "b.png", "--stats", "h.json"}));
    const auto hybrid = nlohmann::json::parse(readFile("h.json")).at("pictures").at(0);
    EXPECT_GT(hybrid.at("counters").at("pixels masked").get<int>(), 0);
    EXPECT_GT(hybrid.at("counters").at("rays traced").get<int>(), 0);
    EXPECT_TRUE(picture.at("decisions").at("motion blur").get<std::string>().starts_with("ran: "));
}

TEST_F(CliRender, ASequenceIsOneFileAFrame) {
    expectSuccess(renderVase({"--frames", "0:2", "--out", "f_%04d.png", "--stats", "s.json"}));
    const std::set<std::string> expected = {
        ".f_%04d.png.journal", "f_0000.png", "f_0001.png", "f_0002.png", "s.json"};
    EXPECT_EQ(listFiles(), expected);
    for (const char* file : {"f_0000.png", "f_0001.png", "f_0002.png"})
        expectPicture(file);
    EXPECT_NE(readFile("f_0000.png"), readFile("f_0002.png"));
    EXPECT_EQ(nlohmann::json::parse(readFile("s.json")).at("pictures").size(), 3u);
    // A frame of a sequence is the picture of its time.
    expectSuccess(renderVase({"--time", fmt::format("{}", 1.0 / 24.0), "--out", "single.png"}));
    EXPECT_EQ(readFile("single.png"), readFile("f_0001.png"));
}

TEST_F(CliRender, APictureOfOnePixelIsDrawnByEveryMethod) {
    for (const char* method : {"sharp", "gather", "hybrid", "accumulate", "truth"}) {
        Arguments arguments =
            renderVase({"--method", method, "--samples", "2", "--out", "pixel.exr"});
        arguments[3] = "1x1";
        expectSuccess(validated(arguments));
        EXPECT_EQ(read("pixel.exr").width, 1u);
        fs::remove(path("pixel.exr"));
    }
}

TEST_F(CliRender, AnEmptySceneIsDrawnAsBackground) {
    writeFile("nothing.gltf", R"({"asset": {"version": "2.0"}})");
    expectSuccess(
        {"render", "nothing.gltf", "--size", "16x16", "--out", "a.png", "--device", "llvmpipe"}
    );
    EXPECT_TRUE(listFiles().contains("a.png"));
}

TEST_F(CliRender, TheRenderGraphIsPrintedOnRequest) {
    expectPrinted(
        renderVase({"--method", "resolved", "--out", "a.png", "--dump-graph"}),
        {"G-buffer", "resolve", "tone map"}
    );
}

TEST_F(CliRender, EveryEffectAndPassIsExplainedOnRequest) {
    const Arguments explained = renderVase({"--method", "hybrid", "--out", "a.png", "--explain"});
    expectPrinted(
        explained,
        {"effect  motion blur",
         "ran, because something in the picture moves during the exposure",
         "work    rays at the raster instant",
         "pass    G-buffer",
         "pass    tile max",
         "ran, because motion blur runs",
         "work    alpha mask",
         "skipped, because no surface in the picture has an alpha mask"}
    );
    const std::string still = expectPrinted(
        join(explained, {"--exposure", "0"}),
        {"skipped, because the exposure is 0", "skipped, because no effect that runs traces any"}
    );
    EXPECT_EQ(still.find("tile max"), std::string::npos) << still;
}

TEST_F(CliRender, AnEnvironmentIsItsDisplayWindowAndChannelsLeftOutAreReported) {
    // A bright frame of a pixel around a grey picture, outside of the display window.
    image::Image picture(66, 34, 4);
    for (uint32_t y = 0; y < 34; ++y)
        for (uint32_t x = 0; x < 66; ++x)
            for (uint32_t c = 0; c < 4; ++c)
                picture.at(x, y, c) = x == 0 || y == 0 || x == 65 || y == 33 ? 1000.0f : 0.4f;
    picture.channelNames = {"R", "G", "B", "Z"};
    ASSERT_TRUE(io::writeImage(path("around.exr"), picture));
    std::string exr = readFile("around.exr");
    const std::string window("displayWindow\0box2i\0\x10\0\0\0", 24);
    const size_t corners = exr.find(window) + window.size();
    for (const auto& [place, value] : {std::pair{0, 1}, {4, 1}, {8, 64}, {12, 32}})
        exr[corners + size_t(place)] = char(value);
    writeFile("around.exr", exr);
    ASSERT_TRUE(io::writeImage(path("plain.exr"), makeGrey(0.4f)));
    expectWarned(
        renderVase({"--out", "a.png", "--environment", "around.exr"}),
        "'around.exr' has channels that are left out: Z"
    );
    expectSuccess(renderVase({"--out", "b.png", "--environment", "plain.exr"}));
    EXPECT_EQ(readFile("a.png"), readFile("b.png"));
}

TEST_F(CliRender, AnEnvironmentOfOneColourIsTheTwoColours) {
    // Twice as bright by its intensity.
    ASSERT_TRUE(io::writeImage(path("grey.exr"), makeGrey(0.2f)));
    expectSuccess(
        renderVase({"--out", "a.exr", "--environment", "grey.exr", "--environment-intensity", "2"})
    );
    expectSuccess(
        renderVase({"--out", "b.exr", "--background", "0.4,0.4,0.4", "--ambient", "0.4,0.4,0.4"})
    );
    expectSuccess(renderVase({"--out", "c.exr"}));
    const image::Image seen = read("a.exr");
    EXPECT_GT(image::computePsnr(seen, read("b.exr")), 55.0);
    EXPECT_LT(image::computePsnr(seen, read("c.exr")), 40.0);
}

TEST_F(CliRender, ASkyIsExplained) {
    expectPrinted(
        renderVase({"--out", "a.png", "--sky", "2.5", "--explain"}),
        {"environment", "it is seen where nothing is"}
    );
    expectPrinted(renderVase({"--out", "b.png", "--explain"}), {"the scene has none"});
}

} // namespace shutter::cli
