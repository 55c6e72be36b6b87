// SPDX-License-Identifier: MIT
#include "engine/scene/shutter.h"
#include "game/options/shutter_options.h"
#include "tests/unit/options/command_words.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

namespace shutter::game {

namespace {

using scene::CameraShutter;
using scene::ResponseShape;
using scene::ShutterMode;

constexpr double kFrame = 1.0 / 25.0;

core::Result<CameraShutter> parse(const Words& words) {
    ShutterArguments arguments;
    const core::Status typed =
        parseWords(words, [&](CLI::App& command) { defineShutterOptions(command, arguments); });
    if (!typed)
        return typed.error();
    return interpretShutter(arguments);
}

CameraShutter accept(const Words& words) {
    const auto shutter = parse(words);
    EXPECT_TRUE(shutter.ok()) << (shutter.ok() ? "" : shutter.error().message);
    return shutter.ok() ? shutter.value() : CameraShutter{};
}

void refuse(const std::string& option, const Words& words) {
    expectRefused(parse(words), option);
}

} // namespace

TEST(ShutterOptions, TheDefaultIsASixtiethOfASecondAndChangesNothingElse) {
    const CameraShutter shutter = accept(Words{});
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

TEST(ShutterOptions, TheModeFollowsWhatIsGivenOrIsGivenItself) {
    EXPECT_EQ(accept(Words{"--shutter-angle=90.0"}).mode, ShutterMode::Angle);
    EXPECT_EQ(accept(Words{"--exposure=0.1"}).mode, ShutterMode::Physical);
    const CameraShutter capped =
        accept(Words{"--shutter-mode=capped", "--reference-fps=50.0", "--shutter-angle=90.0"});
    EXPECT_EQ(capped.mode, ShutterMode::Capped);
    EXPECT_DOUBLE_EQ(scene::computeExposureSeconds(capped, kFrame), 1.0 / 200.0);
    const CameraShutter ntsc = accept(Words{"--shutter-mode=capped", "--reference-fps=24000/1001"});
    EXPECT_EQ(ntsc.referenceFps, 24000.0 / 1001.0);
    const CameraShutter angle = accept(Words{"--shutter-mode=angle"});
    EXPECT_DOUBLE_EQ(scene::computeExposureSeconds(angle, kFrame), 1.0 / 50.0);
}

TEST(ShutterOptions, ModesThatDoNotFitAreRefused) {
    for (const char* mode : {"Physical", "box", "angle ", "180"})
        refuse("--shutter-mode", Words{"--shutter-mode=" + wordOf(mode)});
    refuse("--shutter-mode", Words{"--shutter-mode=physical", "--shutter-angle=180.0"});
    for (const char* mode : {"angle", "capped"})
        refuse("--shutter-mode", Words{"--shutter-mode=" + wordOf(mode), "--exposure=0.1"});
    refuse("--reference-fps", Words{"--reference-fps=24.0"});
    for (const double bad : {0.0, -1.0, kNan, kInfinity})
        refuse("--reference-fps", Words{"--shutter-mode=capped", "--reference-fps=" + wordOf(bad)});
    for (const char* bad : {"0/1", "1/0", "2002/1"})
        refuse("--reference-fps", Words{"--shutter-mode=capped", "--reference-fps=" + wordOf(bad)});
    refuse("--exposure", Words{"--exposure=1/48"});
}

TEST(ShutterOptions, ResponsesHaveTheirNamesAndNumbers) {
    const auto response = [](const char* text) {
        return accept(Words{"--response=" + wordOf(text)}).response;
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
        refuse("--response", Words{"--response=" + wordOf(text)});
    std::string many = "samples:1";
    for (int i = 0; i < 64; ++i)
        many += ",1";
    refuse("--response", Words{"--response=" + wordOf(many)});
}

TEST(ShutterOptions, CutDetectionHasItsThresholds) {
    const CameraShutter shutter = accept(Words{"--cut-angle=30.0", "--cut-distance=2.0"});
    EXPECT_EQ(shutter.cuts.degrees, 30.0);
    EXPECT_EQ(shutter.cuts.metres, 2.0);
    EXPECT_FALSE(accept(Words{"--cut-detection=off"}).cuts.enabled);
    for (const char* word : {"", "yes", "ON"})
        refuse("--cut-detection", Words{"--cut-detection=" + wordOf(word)});
    for (const double bad : {0.0, -1.0, kNan, kInfinity}) {
        refuse("--cut-angle", Words{"--cut-angle=" + wordOf(bad)});
        refuse("--cut-distance", Words{"--cut-distance=" + wordOf(bad)});
    }
    refuse("--cut-angle", Words{"--cut-detection=off", "--cut-angle=5.0"});
    refuse("--cut-distance", Words{"--cut-detection=off", "--cut-distance=5.0"});
}

TEST(ShutterOptions, BlurScalesLieBetweenNothingAndDouble) {
    const CameraShutter shutter = accept(Words{
        "--camera-rotation-blur=0.0", "--camera-translation-blur=2.0", "--object-blur=0.5"});
    EXPECT_EQ(shutter.cameraRotationScale, 0.0);
    EXPECT_EQ(shutter.cameraTranslationScale, 2.0);
    EXPECT_EQ(shutter.objectScale, 0.5);
    for (const double bad : {-0.1, 2.1, kNan, kInfinity}) {
        refuse("--camera-rotation-blur", Words{"--camera-rotation-blur=" + wordOf(bad)});
        refuse("--camera-translation-blur", Words{"--camera-translation-blur=" + wordOf(bad)});
        refuse("--object-blur", Words{"--object-blur=" + wordOf(bad)});
    }
}

TEST(ShutterOptions, EachOptionIsReadAndDistinguishesPictures) {
    // Arguments whose fingerprints must all differ.
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
    for (const auto& line : lines)
        descriptions.insert(scene::describe(accept(line)));
    EXPECT_EQ(descriptions.size(), lines.size());
}

} // namespace shutter::game
