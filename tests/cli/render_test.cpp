// SPDX-License-Identifier: MIT
#include "engine/image/image.h"
#include "engine/io/image_file.h"
#include "tests/cli/cli_fixture.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace shutter::cli {

namespace {

const std::vector<std::string> kMethods = {"sharp", "gather", "hybrid", "accumulate", "truth"};

const std::vector<std::string> kRivals = {
    "own_velocity", "mcguire2012", "guertin2014", "jimenez2014"};

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

} // namespace

TEST_F(CliRender, EveryMethodWritesEveryFormatWithoutAValidationMessage) {
    for (const std::string& method : kMethods)
        for (const char* extension : {"png", "jpg", "exr"}) {
            const std::string file = fmt::format("{}.{}", method, extension);
            Arguments more = {"--method", method, "--out", file};
            if (method == "accumulate" || method == "truth")
                more.insert(more.end(), {"--samples", "4"});
            expectSuccess(validated(renderVase(more)));
            expectPicture(file);
        }
    EXPECT_EQ(listFiles().size(), kMethods.size() * 3); // and no temporary one
}

TEST_F(CliRender, BlurShowsInThePictureOfEveryMethodButSharp) {
    for (const std::string& method : kMethods)
        expectSuccess(renderVase({"--method", method, "--samples", "8", "--out", method + ".exr"}));
    expectSuccess(renderVase({"--method", "hybrid", "--exposure", "0", "--out", "still.exr"}));
    const std::vector<float> sharp = read("sharp.exr").pixels;
    for (const char* method : {"gather", "hybrid", "accumulate", "truth"})
        EXPECT_NE(read(fmt::format("{}.exr", method)).pixels, sharp) << method;
    EXPECT_EQ(read("still.exr").pixels, sharp);
}

TEST_F(CliRender, EachRivalDrawsItsOwnPictureTheSameEachTime) {
    expectSuccess(renderVase({"--method", "sharp", "--out", "sharp.png"}));
    std::set<std::string> pictures = {readFile("sharp.png")};
    for (const std::string& method : kRivals) {
        const std::string file = fmt::format("{}.png", method);
        expectSuccess(validated(renderVase({"--method", method, "--out", file})));
        expectPicture(file);
        const std::string first = readFile(file);
        expectSuccess(renderVase({"--method", method, "--out", file}));
        EXPECT_EQ(readFile(file), first) << method;
        pictures.insert(first);
    }
    EXPECT_EQ(pictures.size(), kRivals.size() + 1) << "no two are alike";
}

TEST_F(CliRender, TheSameCommandTwiceGivesTheSameBytes) {
    for (const std::string& method : kMethods) {
        Arguments more = {"--method", method, "--samples", "4", "--out"};
        for (const char* file : {"a.png", "b.png"}) {
            Arguments command = more;
            command.push_back(file);
            expectSuccess(renderVase(command));
        }
        EXPECT_EQ(readFile("a.png"), readFile("b.png")) << method;
        EXPECT_GT(readFile("a.png").size(), 100u);
    }
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
    fs::create_symlink("loop.png", path("loop.png"));
    expectRefusal(renderVase({"--out", "loop.png"}), 1, {"--out", "loop.png", "in a circle"});
    expectRefusal(
        renderVase({"--out", "b.png", "--stats", "loop.png"}), 1, {"--stats", "in a circle"}
    );
}

TEST_F(CliRender, StatisticsOnStandardOutputFollowWhatWasPrinted) {
    const std::string out =
        expectSuccess(renderVase({"--out", "a.png", "--explain", "--stats", "/dev/stdout"})).out;
    EXPECT_TRUE(out.starts_with("frame at 0 s\n")) << out;
    EXPECT_TRUE(nlohmann::json::accept(out.substr(out.find("\n{") + 1))) << out;
}

TEST_F(CliRender, NoSamplesMeansTheMethodsOwnNumber) {
    expectSuccess(renderVase({"--method", "gather", "--samples", "15", "--out", "own.png"}));
    expectSuccess(renderVase({"--method", "gather", "--out", "none.png"}));
    expectSuccess(renderVase({"--method", "gather", "--samples", "3", "--out", "three.png"}));
    EXPECT_EQ(readFile("own.png"), readFile("none.png"));
    EXPECT_NE(readFile("three.png"), readFile("none.png"));
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
    for (const char* method : {"sharp", "accumulate"}) {
        expectSuccess(renderVase(
            {"--method",
             method,
             "--samples",
             "2",
             "--out",
             fmt::format("{}.exr", method),
             "--aov",
             "all"}
        ));
        EXPECT_TRUE(listFiles().contains(fmt::format("{}.mesh_id.exr", method)));
    }
    EXPECT_EQ(read("sharp.depth.exr").pixels, read("accumulate.depth.exr").pixels);
    expectSuccess(renderVase({"--method", "guertin2014", "--out", "g.exr", "--aov", "all"}));
    EXPECT_EQ(read("g.tiles.exr").width, 2u); // 64 px in tiles of 40
    EXPECT_EQ(read("g.variance.exr").width, 2u);
    EXPECT_FALSE(listFiles().contains("g.mask.exr"));
}

TEST_F(CliRender, AnIntermediateOfABlurThatDidNotRunIsReportedMissing) {
    const Outcome outcome =
        run(renderVase({"--method", "hybrid", "--exposure", "0", "--out", "a.png", "--aov", "mask"})
        );
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(
        outcome.err.find("--aov mask is not written, because motion blur was skipped: the "
                         "exposure is 0\n"),
        std::string::npos
    ) << outcome.err;
    // A single picture has the raster of the frame before it.
    const Outcome first = run(renderVase({"--out", "b.png", "--aov", "last,second"}));
    EXPECT_NE(
        first.err.find("--aov second is not written, because the setting secondRaster is off\n"),
        std::string::npos
    ) << first.err;
    EXPECT_EQ(listFiles(), (std::set<std::string>{"a.png", "b.last.exr", "b.png"}));
}

TEST_F(CliRender, StatisticsAreJsonWithTheDocumentedKeys) {
    expectSuccess(renderVase({"--out", "a.png", "--stats", "s.json", "--repeat", "2"}));
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

TEST_F(CliRender, AnExistingPictureIsReplaced) {
    writeFile("a.png", "an older picture");
    expectSuccess(renderVase({"--method", "sharp", "--out", "a.png"}));
    expectPicture("a.png");
}

TEST_F(CliRender, APictureOfOnePixelIsDrawnByEveryMethod) {
    for (const std::string& method : kMethods) {
        Arguments arguments = {
            "render",
            SHUTTER_ASSETS "/vase.glb",
            "--size",
            "1x1",
            "--method",
            method,
            "--samples",
            "2",
            "--out",
            method + ".exr",
            "--device",
            "llvmpipe"};
        expectSuccess(validated(arguments));
        EXPECT_EQ(read(method + ".exr").width, 1u);
    }
}

TEST_F(CliRender, TheRenderGraphIsPrintedOnRequest) {
    const std::string out = expectSuccess(renderVase({"--out", "a.png", "--dump-graph"})).out;
    for (const char* pass : {"G-buffer", "resolve", "tone map"})
        EXPECT_NE(out.find(pass), std::string::npos) << pass;
}

TEST_F(CliRender, EveryEffectAndPassIsExplainedOnRequest) {
    const std::string ran =
        expectSuccess(renderVase({"--method", "hybrid", "--out", "a.png", "--explain"})).out;
    for (const char* line :
         {"effect  motion blur",
          "ran, because something in the picture moves during the exposure",
          "work    rays at the raster instant",
          "pass    G-buffer",
          "pass    tile max",
          "ran, because motion blur runs",
          "work    alpha mask",
          "skipped, because no surface in the picture has an alpha mask"})
        EXPECT_NE(ran.find(line), std::string::npos) << line << "\n" << ran;

    const std::string still =
        expectSuccess(
            renderVase({"--method", "hybrid", "--out", "a.png", "--explain", "--exposure", "0"})
        )
            .out;
    EXPECT_NE(still.find("skipped, because the exposure is 0"), std::string::npos) << still;
    EXPECT_NE(still.find("skipped, because no effect that runs traces any"), std::string::npos);
    EXPECT_EQ(still.find("tile max"), std::string::npos) << still;
}

} // namespace shutter::cli
