// SPDX-License-Identifier: MIT
#include "engine/scene/shutter.h"
#include "game/options/shutter_options.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace shutter::game {

namespace {

using scene::CameraShutter;
using scene::ResponseShape;
using scene::ShutterMode;
using Change = std::function<void(ShutterArguments&)>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFrame = 1.0 / 25.0;

CameraShutter accept(const Change& change) {
    ShutterArguments arguments;
    change(arguments);
    const auto shutter = interpretShutter(arguments, kFrame);
    EXPECT_TRUE(shutter.ok()) << (shutter.ok() ? "" : shutter.error().message);
    return shutter.ok() ? shutter.value() : CameraShutter{};
}

/// The sentence names `option`, is one line and ends without a full stop.
void refuse(const std::string& option, const Change& change) {
    ShutterArguments arguments;
    change(arguments);
    const auto shutter = interpretShutter(arguments, kFrame);
    ASSERT_FALSE(shutter.ok()) << option;
    const std::string& message = shutter.error().message;
    EXPECT_NE(message.find(option), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.back(), '.') << message;
}

} // namespace

TEST(ShutterOptions, TheDefaultIsASixtiethOfASecondAndChangesNothingElse) {
    const CameraShutter shutter = accept([](auto&) {});
    const CameraShutter plain;
    EXPECT_EQ(shutter.mode, ShutterMode::Physical);
    EXPECT_EQ(shutter.exposureSeconds, 1.0 / 60.0);
    EXPECT_EQ(shutter.response.shape, ResponseShape::Box);
    EXPECT_TRUE(shutter.cuts.enabled);
    EXPECT_EQ(shutter.cuts.degrees, plain.cuts.degrees);
    EXPECT_EQ(shutter.cuts.metres, plain.cuts.metres);
    EXPECT_EQ(shutter.cameraRotationScale, 1.0);
    EXPECT_EQ(shutter.cameraTranslationScale, 1.0);
    EXPECT_EQ(shutter.objectScale, 1.0);
}

TEST(ShutterOptions, TheModeFollowsWhatIsGivenOrSaysItself) {
    EXPECT_EQ(accept([](auto& a) { a.shutterAngle = 90.0; }).mode, ShutterMode::Angle);
    EXPECT_EQ(accept([](auto& a) { a.exposureSeconds = 0.1; }).mode, ShutterMode::Physical);
    const CameraShutter capped = accept([](auto& a) {
        a.shutterMode = "capped";
        a.referenceFps = 50.0;
        a.shutterAngle = 90.0;
    });
    EXPECT_EQ(capped.mode, ShutterMode::Capped);
    EXPECT_DOUBLE_EQ(scene::computeExposureSeconds(capped, kFrame), 1.0 / 200.0);
    const CameraShutter angle = accept([](auto& a) { a.shutterMode = "angle"; });
    EXPECT_DOUBLE_EQ(scene::computeExposureSeconds(angle, kFrame), 1.0 / 50.0);
}

TEST(ShutterOptions, ModesThatDoNotFitAreRefused) {
    for (const char* mode : {"Physical", "box", "angle ", "180"})
        refuse("--shutter-mode", [&](auto& a) { a.shutterMode = mode; });
    refuse("--shutter-mode", [](auto& a) {
        a.shutterMode = "physical";
        a.shutterAngle = 180.0;
    });
    for (const char* mode : {"angle", "capped"})
        refuse("--shutter-mode", [&](auto& a) {
            a.shutterMode = mode;
            a.exposureSeconds = 0.1;
        });
    refuse("--reference-fps", [](auto& a) { a.referenceFps = 24.0; });
    for (const double bad : {0.0, -1.0, kNan, kInfinity})
        refuse("--reference-fps", [&](auto& a) {
            a.shutterMode = "capped";
            a.referenceFps = bad;
        });
}

TEST(ShutterOptions, ResponsesHaveTheirNamesAndNumbers) {
    const auto response = [](const char* text) {
        return accept([&](auto& a) { a.response = text; }).response;
    };
    EXPECT_EQ(response("box").shape, ResponseShape::Box);
    EXPECT_EQ(response("triangle").shape, ResponseShape::Triangle);
    const auto trapezoid = response("trapezoid:0.2,0.35");
    EXPECT_EQ(trapezoid.shape, ResponseShape::Trapezoid);
    EXPECT_EQ(trapezoid.openShare, 0.2);
    EXPECT_EQ(trapezoid.closeShare, 0.35);
    const auto samples = response("samples:0,1,0.5,1e-3");
    EXPECT_EQ(samples.shape, ResponseShape::Sampled);
    EXPECT_EQ(samples.samples, (std::vector<double>{0.0, 1.0, 0.5, 1e-3}));
}

TEST(ShutterOptions, BadResponsesAreRefused) {
    for (const char* text :
         {"",
          "round",
          "box:",
          "box:1",
          "triangle:1",
          "trapezoid",
          "trapezoid:",
          "trapezoid:0.1",
          "trapezoid:0.1,0.2,0.3",
          "trapezoid:0.6,0.5",
          "trapezoid:-0.1,0.5",
          "trapezoid:nan,0.5",
          "trapezoid:a,b",
          "samples",
          "samples:1",
          "samples:0,0",
          "samples:1,-1",
          "samples:1,inf",
          "samples:1,,1",
          "samples:1,1,"})
        refuse("--response", [&](auto& a) { a.response = text; });
    std::string many = "samples:1";
    for (int i = 0; i < 64; ++i)
        many += ",1";
    refuse("--response", [&](auto& a) { a.response = many; });
}

TEST(ShutterOptions, CutDetectionHasItsThresholds) {
    const CameraShutter shutter = accept([](auto& a) {
        a.cutAngle = 30.0;
        a.cutDistance = 2.0;
    });
    EXPECT_EQ(shutter.cuts.degrees, 30.0);
    EXPECT_EQ(shutter.cuts.metres, 2.0);
    EXPECT_FALSE(accept([](auto& a) { a.cutDetection = "off"; }).cuts.enabled);
    for (const char* word : {"", "yes", "ON"})
        refuse("--cut-detection", [&](auto& a) { a.cutDetection = word; });
    for (const double bad : {0.0, -1.0, kNan, kInfinity}) {
        refuse("--cut-angle", [&](auto& a) { a.cutAngle = bad; });
        refuse("--cut-distance", [&](auto& a) { a.cutDistance = bad; });
    }
    refuse("--cut-angle", [](auto& a) {
        a.cutDetection = "off";
        a.cutAngle = 5.0;
    });
    refuse("--cut-distance", [](auto& a) {
        a.cutDetection = "off";
        a.cutDistance = 5.0;
    });
}

TEST(ShutterOptions, BlurScalesLieBetweenNothingAndDouble) {
    const CameraShutter shutter = accept([](auto& a) {
        a.cameraRotationBlur = 0.0;
        a.cameraTranslationBlur = 2.0;
        a.objectBlur = 0.5;
    });
    EXPECT_EQ(shutter.cameraRotationScale, 0.0);
    EXPECT_EQ(shutter.cameraTranslationScale, 2.0);
    EXPECT_EQ(shutter.objectScale, 0.5);
    for (const double bad : {-0.1, 2.1, kNan, kInfinity}) {
        refuse("--camera-rotation-blur", [&](auto& a) { a.cameraRotationBlur = bad; });
        refuse("--camera-translation-blur", [&](auto& a) { a.cameraTranslationBlur = bad; });
        refuse("--object-blur", [&](auto& a) { a.objectBlur = bad; });
    }
}

TEST(ShutterOptions, EachOptionIsReadAndTellsPicturesApart) {
    // What is typed, and the whole line of each must differ from all others.
    const std::vector<std::vector<std::string>> lines = {
        {},
        {"--exposure", "0.5"},
        {"--shutter-angle", "0.5"},
        {"--shutter-mode", "angle"},
        {"--shutter-mode", "capped"},
        {"--shutter-mode", "capped", "--reference-fps", "30"},
        {"--phase", "centre"},
        {"--response", "triangle"},
        {"--response", "trapezoid:0.1,0.2"},
        {"--cut-detection", "off"},
        {"--cut-angle", "7"},
        {"--cut-distance", "7"},
        {"--camera-rotation-blur", "0.5"},
        {"--camera-translation-blur", "0.5"},
        {"--object-blur", "0.5"}};
    std::set<std::string> descriptions;
    for (const auto& line : lines) {
        CLI::App app;
        ShutterArguments arguments;
        defineShutterOptions(app, arguments);
        app.parse(std::vector<std::string>(line.rbegin(), line.rend())
        ); // it takes them from behind
        EXPECT_TRUE(interpretShutter(arguments, kFrame).ok());
        descriptions.insert(describeShutter(arguments));
    }
    EXPECT_EQ(descriptions.size(), lines.size());
}

} // namespace shutter::game
