// SPDX-License-Identifier: MIT
#include "engine/image/image.h"
#include "engine/io/image_file.h"
#include "tests/cli/cli_fixture.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace shutter::cli {

namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 2;

class CliCompare : public Cli {
  protected:
    void writePicture(
        const std::string& name,
        uint32_t size,
        uint32_t channels,
        float value,
        const std::vector<std::string>& channelNames = {}
    ) const {
        image::Image picture(size, size, channels);
        for (float& pixel : picture.pixels)
            pixel = value;
        picture.channelNames = channelNames;
        const core::Status written = io::writeImage(path(name), picture);
        ASSERT_TRUE(written.ok()) << written.error().message;
    }

    [[nodiscard]] nlohmann::json compareAsJson(Arguments arguments) const {
        arguments.insert(arguments.begin(), "compare");
        arguments.push_back("--json");
        return nlohmann::json::parse(expectSuccess(arguments).out);
    }
};

} // namespace

TEST_F(CliCompare, AMissingOrDamagedFileIsNamed) {
    writePicture("a.png", 16, 3, 0.5f);
    writeFile("text.png", "no picture");
    expectRefusal({"compare", "a.png", "nosuch.png"}, kFailed, {"nosuch.png"});
    expectRefusal({"compare", "nosuch.png", "a.png"}, kFailed, {"nosuch.png"});
    expectRefusal({"compare", "a.png", "text.png"}, kFailed, {"text.png"});
    expectRefusal({"compare", "a.png", "."}, kFailed, {"."});
}

TEST_F(CliCompare, TwoPicturesAreNeeded) {
    expectRefusal({"compare"}, kUsage, {"a"});
    expectRefusal({"compare", "a.png"}, kUsage, {"b"});
}

TEST_F(CliCompare, PicturesOfTwoSizesAreRefusedWithBoth) {
    writePicture("a.png", 16, 3, 0.5f);
    writePicture("b.png", 17, 3, 0.5f);
    expectRefusal(
        {"compare", "a.png", "b.png", "--out", "heat.png"},
        kFailed,
        {"a.png", "16x16", "b.png", "17x17"}
    );
}

TEST_F(CliCompare, PicturesOfTwoKindsAreRefused) {
    writePicture("a.exr", 16, 3, 0.5f);
    writePicture("b.exr", 16, 1, 0.5f);
    expectRefusal({"compare", "a.exr", "b.exr"}, kFailed, {"a.exr", "b.exr", "channels"});
}

TEST_F(CliCompare, AHeatMapThatCannotBeWrittenIsRefused) {
    writePicture("a.png", 16, 3, 0.5f);
    for (const char* out : {"nosuch/heat.png", "heat.bmp"})
        expectRefusal({"compare", "a.png", "a.png", "--out", out}, kFailed, {"--out", out});
}

TEST_F(CliCompare, EqualPicturesAreEqual) {
    writePicture("a.png", 16, 3, 0.5f);
    EXPECT_EQ(
        expectSuccess({"compare", "a.png", "a.png"}).out,
        "PSNR inf dB  SSIM 1.0000  FLIP 0.0000  (display values as stored)\n"
    );
    const auto json = compareAsJson({"a.png", "a.png"});
    EXPECT_EQ(json.at("equal"), true);
    EXPECT_TRUE(json.at("psnr_db").is_null());
    EXPECT_EQ(json.at("ssim"), 1.0);
    EXPECT_EQ(json.at("flip"), 0.0);
    EXPECT_EQ(json.at("values"), "display");
    EXPECT_TRUE(json.at("tonemap").is_null());
    EXPECT_EQ(json.at("max_difference"), 0.0);
}

TEST_F(CliCompare, LinearTakesTheValuesAsTheyAreStored) {
    writePicture("a.exr", 16, 3, 0.5f);
    writePicture("b.exr", 16, 3, 0.6f);
    const auto json = compareAsJson({"a.exr", "b.exr", "--linear"});
    EXPECT_EQ(json.at("equal"), false);
    EXPECT_NEAR(json.at("psnr_db").get<double>(), 20.0, 1e-4);
    EXPECT_NEAR(json.at("max_difference").get<double>(), 0.1, 1e-6);
    EXPECT_LT(json.at("ssim").get<double>(), 1.0);
    EXPECT_TRUE(json.at("flip").is_null()) << "FLIP models what a display shows";
    EXPECT_EQ(json.at("values"), "stored");
    EXPECT_TRUE(json.at("tonemap").is_null());
    const std::string text = expectSuccess({"compare", "a.exr", "b.exr", "--linear"}).out;
    EXPECT_EQ(text.find("FLIP"), std::string::npos) << text;
    EXPECT_NE(text.find("as stored"), std::string::npos) << text;
}

TEST_F(CliCompare, LinearPicturesAreToneMappedAlike) {
    writePicture("a.exr", 16, 3, 0.04f);
    writePicture("b.exr", 16, 3, 0.5f);
    // sRGB alone: 0.22092 and 0.73536.
    auto json = compareAsJson({"a.exr", "b.exr", "--tonemap", "none"});
    EXPECT_NEAR(json.at("max_difference").get<double>(), 0.51444, 1e-4);
    EXPECT_EQ(json.at("values"), "display");
    EXPECT_EQ(json.at("tonemap").at("operator"), "none");
    EXPECT_EQ(json.at("tonemap").at("applied_to"), nlohmann::json({"a", "b"}));
    EXPECT_GT(json.at("flip").get<double>(), 0.3);
    // Neutral takes 0.04 - 6.25 * 0.04^2 = 0.03 and 0.04 off: sRGB of 0.01 and 0.46.
    json = compareAsJson({"a.exr", "b.exr"});
    EXPECT_NEAR(json.at("max_difference").get<double>(), 0.60852, 1e-4);
    EXPECT_EQ(json.at("tonemap").at("operator"), "neutral");
    EXPECT_EQ(json.at("tonemap").at("ev"), 0.0);
    json = compareAsJson({"a.exr", "b.exr", "--tonemap", "none", "--ev", "1"});
    EXPECT_NEAR(json.at("max_difference").get<double>(), 1.0 - 0.31330, 1e-4);
    EXPECT_EQ(json.at("tonemap").at("ev"), 1.0);
    const std::string text = expectSuccess({"compare", "a.exr", "b.exr", "--ev", "-1.5"}).out;
    EXPECT_NE(text.find("(display values, tone map neutral, EV -1.5)"), std::string::npos) << text;
}

TEST_F(CliCompare, ALinearPictureAgreesWithItsDisplayPicture) {
    writePicture("linear.exr", 16, 3, 0.5f);
    writePicture("display.png", 16, 3, 0.735357f);
    const auto json = compareAsJson({"linear.exr", "display.png", "--tonemap", "none"});
    EXPECT_LT(json.at("max_difference").get<double>(), 0.5 / 255.0);
    EXPECT_EQ(json.at("values"), "display");
    EXPECT_EQ(json.at("tonemap").at("applied_to"), nlohmann::json::array({"a"}));
    const std::string text = expectSuccess({"compare", "display.png", "linear.exr"}).out;
    EXPECT_NE(text.find("EV 0 of 'linear.exr' alone"), std::string::npos) << text;
}

TEST_F(CliCompare, ADisplayPictureIsNotToneMapped) {
    writePicture("a.png", 16, 3, 0.2f);
    writePicture("b.png", 16, 3, 0.4f);
    EXPECT_EQ(
        compareAsJson({"a.png", "b.png", "--ev", "3"}),
        compareAsJson({"a.png", "b.png", "--linear"})
    );
}

TEST_F(CliCompare, WhatIsNoColourIsComparedAsStoredOrNotAtAll) {
    writePicture("motion.exr", 16, 2, 3.0f, {"motion.x", "motion.y"});
    writePicture("normal.exr", 16, 3, 0.5f, {"N.x", "N.y", "N.z"});
    writePicture("depth.exr", 16, 1, 7.0f, {"Z"});
    for (const char* name : {"motion.exr", "normal.exr", "depth.exr"}) {
        expectRefusal({"compare", name, name}, kFailed, {name, "--linear"});
        EXPECT_EQ(compareAsJson({name, name, "--linear"}).at("equal"), true);
    }
    writePicture("layer.exr", 16, 3, 0.5f, {"layer.R", "layer.G", "layer.B"});
    EXPECT_EQ(compareAsJson({"layer.exr", "layer.exr"}).at("values"), "display");
}

TEST_F(CliCompare, OptionsWithoutMeaningAreRefused) {
    writePicture("a.exr", 16, 3, 0.5f);
    const Arguments base = {"compare", "a.exr", "a.exr"};
    const auto refuse = [&](const Arguments& more, int status, const Arguments& mentions) {
        Arguments all = base;
        all.insert(all.end(), more.begin(), more.end());
        expectRefusal(all, status, mentions);
    };
    refuse({"--tonemap", "aces"}, kUsage, {"--tonemap", "aces"});
    refuse({"--ev", "33"}, kUsage, {"--ev"});
    refuse({"--ev", "nan"}, kUsage, {"--ev"});
    refuse({"--linear", "--ev", "1"}, kUsage, {"--linear", "--ev"});
    refuse({"--linear", "--tonemap", "none"}, kUsage, {"--linear", "--tonemap"});
    refuse({"--map", "heat", "--out", "m.png"}, kUsage, {"--map", "heat"});
    refuse({"--map", "flip"}, kUsage, {"--map", "--out"});
    refuse({"--map", "flip", "--linear", "--out", "m.png"}, kFailed, {"--map", "a.exr"});
}

TEST_F(CliCompare, APictureOfNansStillGivesValidJsonAndTheWorstMaps) {
    writePicture("a.exr", 16, 3, 0.5f);
    writePicture("nan.exr", 16, 3, std::numeric_limits<float>::quiet_NaN());
    const auto json = compareAsJson({"a.exr", "nan.exr", "--out", "flip.exr"});
    EXPECT_EQ(json.at("equal"), false);
    EXPECT_EQ(json.at("flip"), 1.0);
    EXPECT_EQ(json.at("psnr_db"), 0.0);
    EXPECT_EQ(io::readImage(path("flip.exr")).value().at(3, 4, 0), 1.0f);
    expectSuccess({"compare", "a.exr", "nan.exr", "--linear", "--out", "heat.exr"});
    EXPECT_EQ(io::readImage(path("heat.exr")).value().at(3, 4, 2), 1.0f);
}

TEST_F(CliCompare, TheErrorMapIsBlackWhereEqualAndBrightWhereNot) {
    writePicture("a.png", 16, 3, 0.0f);
    writePicture("b.png", 16, 3, 1.0f);
    const auto map = [&](const Arguments& more) {
        Arguments arguments = {"compare", "a.png", "b.png", "--out"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expectSuccess(arguments);
        auto read = io::readImage(path(more.front()));
        EXPECT_TRUE(read.ok());
        return read.ok() ? std::move(read.value()) : image::Image(16, 16, 3);
    };
    const double flip = compareAsJson({"a.png", "b.png"}).at("flip").get<double>();
    const image::Image colors = map({"flip.png"});
    EXPECT_EQ(colors.width, 16u);
    EXPECT_GT(colors.at(3, 4, 0), 0.95f) << "magma ends in pale yellow";
    EXPECT_NEAR(colors.at(3, 4, 2), 0.7f, 0.06f);
    const image::Image errors = map({"flip.exr"});
    ASSERT_EQ(errors.channels, 1u) << "an EXR holds the errors themselves";
    EXPECT_NEAR(double(errors.at(3, 4, 0)), flip, 1e-6);
    const image::Image heat = map({"heat.exr", "--map", "difference"});
    ASSERT_EQ(heat.channels, 3u);
    EXPECT_EQ(heat.at(3, 4, 2), 1.0f);
    expectSuccess({"compare", "a.png", "a.png", "--out", "equal.exr"});
    EXPECT_EQ(io::readImage(path("equal.exr")).value().at(3, 4, 0), 0.0f);
}

TEST_F(Cli, InfoNeedsToKnowWhatAbout) {
    expectRefusal({"info"}, kUsage, {"SCENE", "--devices", "--methods"});
}

TEST_F(Cli, InfoListsTheMethodsOnePerLineAsErrorsNameThem) {
    std::string names = expectSuccess({"info", "--methods"}).out;
    ASSERT_TRUE(
        names.starts_with("sharp\n") &&
        names.ends_with("\nhybrid\nresolved\nadaptive\ndenoised\naccumulate\ntruth\n")
    ) << names;
    names.pop_back();
    for (size_t at = 0; (at = names.find('\n', at)) != std::string::npos;)
        names.replace(at, 1, ", ");
    expectRefusal(
        renderVase({"--out", "a.png", "--method", "nosuch"}), kUsage, {"--method", names}
    );
}

TEST_F(Cli, InfoPrintsTheSchemaOfTheSettings) {
    const std::string schema = expectSuccess({"info", "--schema"}).out;
    for (const char* part : {"\"$schema\"", "tileSizePx", "exposureSeconds", "\"hybrid\""})
        EXPECT_NE(schema.find(part), std::string::npos) << part;
}

TEST_F(Cli, InfoListsDevicesWithTheirRays) {
    requireDevice();
    if (IsSkipped())
        return;
    const std::string out = expectSuccess({"info", "--devices"}).out;
    EXPECT_NE(out.find("0: "), std::string::npos);
    EXPECT_NE(out.find("software"), std::string::npos);
    EXPECT_NE(out.find("rays: "), std::string::npos);
    EXPECT_NE(out.find("VK_KHR_ray_query"), std::string::npos);
    EXPECT_NE(out.find("VK_KHR_ray_tracing_pipeline"), std::string::npos);
}

TEST_F(Cli, InfoCountsWhatASceneHolds) {
    writeFile("points.bin", std::string(36, '\0'));
    writeFile(
        "two.gltf",
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
            "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [4, 0, 0]},
                      {"camera": 0, "name": "eye"}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
            "meshes": [{"name": "face", "primitives": [{"attributes": {"POSITION": 0},
                        "targets": [{"POSITION": 0}]}]}],
            "skins": [{"name": "rig", "joints": [0, 1]}],
            "animations": [{"name": "nod", "samplers": [{"input": 1, "output": 1}], "channels":
                            [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [0, 0, 0], "max": [0, 0, 0]},
                          {"bufferView": 0, "componentType": 5126, "count": 1, "type": "SCALAR",
                           "min": [0], "max": [0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": "points.bin"}]})"
    );
    const std::string out = expectSuccess({"info", "two.gltf"}).out;
    for (const char* part :
         {"entities 3",
          "drawn 2",
          "triangles drawn 2",
          "meshes 1",
          "lights 0",
          "bounds 0 0 0 to 4 0 0 m",
          "camera 0: ",
          "eye",
          "clip nod: 0 s, 1 channels",
          "skin rig: 2 joints",
          "mesh face: 1 morph targets"})
        EXPECT_NE(out.find(part), std::string::npos) << part << "\n" << out;
}

} // namespace shutter::cli
