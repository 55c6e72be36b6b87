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
    void
    writePicture(const std::string& name, uint32_t size, uint32_t channels, float value) const {
        image::Image picture(size, size, channels);
        for (float& pixel : picture.pixels)
            pixel = value;
        const core::Status written = io::writeImage(path(name), picture);
        ASSERT_TRUE(written.ok()) << written.error().message;
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
    EXPECT_EQ(expectSuccess({"compare", "a.png", "a.png"}).out, "PSNR inf dB  SSIM 1.0000\n");
    const auto json =
        nlohmann::json::parse(expectSuccess({"compare", "a.png", "a.png", "--json"}).out);
    EXPECT_EQ(json.at("equal"), true);
    EXPECT_TRUE(json.at("psnr_db").is_null());
    EXPECT_EQ(json.at("ssim"), 1.0);
    EXPECT_EQ(json.at("max_difference"), 0.0);
}

TEST_F(CliCompare, ADifferenceOfATenthIsTwentyDecibels) {
    writePicture("a.exr", 16, 3, 0.5f);
    writePicture("b.exr", 16, 3, 0.6f);
    const auto json =
        nlohmann::json::parse(expectSuccess({"compare", "a.exr", "b.exr", "--json"}).out);
    EXPECT_EQ(json.at("equal"), false);
    EXPECT_NEAR(json.at("psnr_db").get<double>(), 20.0, 1e-4);
    EXPECT_NEAR(json.at("max_difference").get<double>(), 0.1, 1e-6);
    EXPECT_LT(json.at("ssim").get<double>(), 1.0);
}

TEST_F(CliCompare, APictureOfNansStillGivesValidJson) {
    writePicture("a.exr", 16, 3, 0.5f);
    writePicture("nan.exr", 16, 3, std::numeric_limits<float>::quiet_NaN());
    const Outcome outcome = run({"compare", "a.exr", "nan.exr", "--json", "--out", "heat.png"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(nlohmann::json::parse(outcome.out).at("equal"), false);
}

TEST_F(CliCompare, TheHeatMapIsBlackWhereEqualAndBrightWhereNot) {
    writePicture("a.exr", 16, 3, 0.0f);
    writePicture("b.exr", 16, 3, 1.0f);
    expectSuccess({"compare", "a.exr", "a.exr", "--out", "black.exr"});
    expectSuccess({"compare", "a.exr", "b.exr", "--out", "white.exr"});
    const auto black = io::readImage(path("black.exr"));
    const auto white = io::readImage(path("white.exr"));
    ASSERT_TRUE(black.ok() && white.ok());
    EXPECT_EQ(black.value().at(3, 4, 1), 0.0f);
    EXPECT_EQ(white.value().at(3, 4, 1), 1.0f);
    EXPECT_EQ(white.value().width, 16u);
}

TEST_F(Cli, InfoNeedsToKnowWhatAbout) {
    expectRefusal({"info"}, kUsage, {"SCENE", "--devices", "--methods"});
}

TEST_F(Cli, InfoListsTheMethodsOneALine) {
    EXPECT_EQ(expectSuccess({"info", "--methods"}).out, "sharp\ngather\nhybrid\naccumulate\n");
}

TEST_F(Cli, InfoListsDevicesWithTheirRays) {
    requireDevice();
    if (IsSkipped())
        return;
    const std::string out = expectSuccess({"info", "--devices"}).out;
    EXPECT_NE(out.find("0: "), std::string::npos);
    EXPECT_NE(out.find("software"), std::string::npos);
    EXPECT_NE(out.find("rays: "), std::string::npos);
}

TEST_F(Cli, InfoCountsWhatASceneHolds) {
    writeFile("points.bin", std::string(36, '\0'));
    writeFile(
        "two.gltf",
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
            "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [4, 0, 0]},
                      {"camera": 0, "name": "eye"}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [0, 0, 0], "max": [0, 0, 0]}],
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
          "eye"})
        EXPECT_NE(out.find(part), std::string::npos) << part << "\n" << out;
}

} // namespace shutter::cli
