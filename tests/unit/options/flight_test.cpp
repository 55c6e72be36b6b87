// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"
#include "game/options/render_arguments.h"
#include "game/shot/shot.h"
#include "tests/unit/options/command_words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace shutter::game {
namespace {

class Flight : public testing::Test {
  protected:
    Flight() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        mFile = std::filesystem::path(testing::TempDir()) /
                (std::string("flight_") + test->name() + ".json");
        write(R"({"version": 1, "fps": 10, "keys": [
            {"time": 0.25, "position": [0, 0, 1], "lookAt": [0, 0, 0],
             "shutter": {"exposure": 0.125}},
            {"time": 0.6, "position": [0, 0, 2], "lookAt": [0, 0, 0],
             "shutter": {"shutterAngle": 90, "phase": "start"}}]})");
        mArguments.scene = "scene.glb";
        mArguments.flythrough = mFile.string();
    }

    ~Flight() override { std::filesystem::remove(mFile); }

    void write(const std::string& text) const { ASSERT_TRUE(io::writeFileText(mFile, text).ok()); }

    [[nodiscard]] ShotOptions load() const {
        auto options = interpret(mArguments);
        EXPECT_TRUE(options.ok()) << (options.ok() ? "" : options.error().message);
        const core::Status loaded = loadFlythrough(mArguments, options.value());
        EXPECT_TRUE(loaded.ok()) << (loaded.ok() ? "" : loaded.error().message);
        return std::move(options).value();
    }

    std::filesystem::path mFile;
    ShotArguments mArguments;
};

TEST_F(Flight, AllFramesWithinItAreDrawnAtTheFilesRate) {
    const ShotOptions options = load();
    EXPECT_EQ(options.frameTimes, (std::vector<double>{3 / 10.0, 4 / 10.0, 5 / 10.0, 6 / 10.0}));
    EXPECT_EQ(options.firstFrame, 3);
    EXPECT_EQ(options.frameSeconds, 0.1);
    EXPECT_TRUE(options.isSequence);
    EXPECT_FALSE(options.flythroughHash.empty());
}

TEST_F(Flight, CommandLineOptionsOverrideTheFile) {
    mArguments.fps = 4.0;
    EXPECT_EQ(load().frameTimes, (std::vector<double>{0.25, 0.5}));
    EXPECT_EQ(load().frameSeconds, 0.25);
    mArguments.frames = "7:8";
    EXPECT_EQ(load().frameTimes, (std::vector<double>{1.75, 2.0}));
    mArguments.fps.reset();
    EXPECT_EQ(load().frameTimes, (std::vector<double>{0.7, 0.8}));
    EXPECT_TRUE(load().isFlythroughShutter);
    mArguments.shutter.typed.insert("--exposure");
    EXPECT_FALSE(load().isFlythroughShutter);
}

TEST_F(Flight, AMomentIsOneFrame) {
    write(R"({"version": 1, "fps": 10, "keys": [
        {"time": 0.31, "position": [0, 0, 1], "lookAt": [0, 0, 0]}]})");
    EXPECT_EQ(load().frameTimes, std::vector<double>{4 / 10.0});
}

TEST_F(Flight, SlowMotionHasMoreFramesOfShorterExposures) {
    write(R"({"version": 1, "fps": 10, "keys": [
        {"time": 0, "position": [0, 0, 1], "lookAt": [0, 0, 0], "timeScale": 0.5,
         "shutter": {"shutterAngle": 180, "phase": "end"}},
        {"time": 0.2, "position": [0, 0, 2], "lookAt": [0, 0, 0]}]})");
    const ShotOptions options = load();
    ASSERT_EQ(options.frameTimes.size(), 5u);
    for (size_t i = 0; i < 5; ++i)
        EXPECT_NEAR(options.frameTimes[i], 0.05 * double(i), 1.0e-12);
    const auto exposure = computeExposure(options, options.shutter, options.frameTimes[2]);
    EXPECT_NEAR(exposure.close - exposure.open, 0.025, 1.0e-12);
    EXPECT_NEAR(exposure.frameSeconds, 0.05, 1.0e-12);
    // The same frame by its number.
    mArguments.frames = "2:2";
    EXPECT_EQ(load().frameTimes, std::vector<double>{options.frameTimes[2]});
}

TEST_F(Flight, ARampBeyondAllTimesIsRefused) {
    write(R"({"version": 1, "fps": 10, "keys": [
        {"time": 0, "position": [0, 0, 1], "lookAt": [0, 0, 0], "timeScale": 1000}]})");
    mArguments.fps = 1.0e-3;
    mArguments.frames = "0:1001";
    auto options = interpret(mArguments);
    ASSERT_TRUE(options.ok()) << options.error().message;
    const core::Status loaded = loadFlythrough(mArguments, options.value());
    ASSERT_FALSE(loaded.ok());
    EXPECT_NE(loaded.error().message.find("timeScale"), std::string::npos);
}

TEST_F(Flight, AnOverlongFlightIsRefused) {
    write(R"({"version": 1, "fps": 1000, "keys": [
        {"time": 0, "position": [0, 0, 1], "lookAt": [0, 0, 0]},
        {"time": 1000, "position": [0, 0, 1], "lookAt": [0, 0, 0]}]})");
    auto options = interpret(mArguments);
    ASSERT_TRUE(options.ok());
    const core::Status loaded = loadFlythrough(mArguments, options.value());
    ASSERT_FALSE(loaded.ok());
    EXPECT_EQ(loaded.error().message, "--flythrough: 1000001 frames are too many");
}

TEST_F(Flight, EachFrameHasTheShutterOfItsTime) {
    ShotOptions options = load();
    Shot shot;
    shot.camera = flythrough::addFlythroughCamera(shot.world, *options.flythrough);
    shot.world.registry.add(shot.camera, options.shutter);
    EXPECT_EQ(makeView(shot, options, 0.5).exposure.open, 0.5 - 0.125);
    const scene::ExposureInterval last = makeView(shot, options, 0.6).exposure;
    EXPECT_EQ(last.open, 0.6);
    EXPECT_DOUBLE_EQ(last.close, 0.6 + 0.025);
    options.isFlythroughShutter = false;
    EXPECT_EQ(makeView(shot, options, 0.6).exposure.close, 0.6);
}

TEST_F(Flight, AClipWithoutANameOrIndexIsRefused) {
    mArguments.flythrough = "clip:";
    const auto options = interpret(mArguments);
    ASSERT_FALSE(options.ok());
    EXPECT_NE(options.error().message.find("--flythrough clip:"), std::string::npos);
}

TEST_F(Flight, AClipFliesTheFirstCameraThatItMovesAlone) {
    scene::World world;
    world.assets.clips.resize(3);
    world.assets.clips[1].name = "pan";
    world.assets.clips[1].duration = 0.5;
    world.playback.activeClips = {true, false, true};
    const auto addCamera = [&](std::vector<uint32_t> clips, ecs::Entity parent) {
        const ecs::Entity camera = world.registry.create();
        world.registry.add(camera, scene::Camera{});
        scene::Animated animated;
        for (const uint32_t clip : clips)
            animated.channels.push_back({clip, 0});
        world.registry.add(camera, animated);
        world.registry.add(camera, scene::Parent{parent});
        world.cameras.push_back(camera);
        return camera;
    };
    addCamera({0}, ecs::kNullEntity);
    const ecs::Entity crane = addCamera({1}, ecs::kNullEntity);
    world.cameras.pop_back(); // a parent that is moved, and no camera of the scene's list
    const ecs::Entity rider = addCamera({2}, crane);
    ShotOptions options;
    options.flythroughClip = "pan";
    const auto chosen = chooseClipCamera(world, options);
    ASSERT_TRUE(chosen.ok()) << chosen.error().message;
    EXPECT_EQ(chosen.value(), rider);
    EXPECT_EQ(world.playback.activeClips, (std::vector<bool>{true, true, false}));
    ASSERT_TRUE(planClipFrames(world, options).ok());
    EXPECT_EQ(options.frameTimes.size(), 13u); // 0 to 12 at 24 a second
    options.camera = "0";
    EXPECT_FALSE(chooseClipCamera(world, options).ok());
    options.camera.clear();
    options.flythroughClip = "tilt";
    const auto missing = chooseClipCamera(world, options);
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.error().message.find("clip:tilt"), std::string::npos);
}

TEST(Fingerprint, TheFingerprintHasExactlyThePicturesInputs) {
    const auto describe = [](Words words) {
        words.insert(words.begin(), {"scene.glb", "--out", "f_%d.png"});
        RenderArguments arguments;
        const core::Status typed =
            parseWords(words, [&](CLI::App& command) { defineRenderOptions(command, arguments); });
        EXPECT_TRUE(typed.ok()) << (typed.ok() ? "" : typed.error().message);
        const auto options = interpret(arguments);
        EXPECT_TRUE(options.ok()) << (options.ok() ? "" : options.error().message);
        return options ? options.value().fingerprint : std::string();
    };
    const std::string plain = describe({});
    const std::map<std::string, Words> matters = {
        {"--aa", {"--aa", "taa"}},
        {"--ambient", {"--ambient", "1,1,1"}},
        {"--aov", {"--aov", "motion"}},
        {"--background", {"--background", "1,1,1"}},
        {"--bloom", {"--bloom", "0.1"}},
        {"--bloom-knee", {"--bloom-knee", "0.1"}},
        {"--bloom-threshold", {"--bloom-threshold", "2"}},
        {"--budget", {"--budget", "8"}},
        {"--camera", {"--camera", "x"}},
        {"--camera-rotation-blur", {"--camera-rotation-blur", "0.5"}},
        {"--camera-translation-blur", {"--camera-translation-blur", "0.5"}},
        {"--clip", {"--clip", "x"}},
        {"--cut-angle", {"--cut-angle", "7"}},
        {"--cut-detection", {"--cut-detection", "off"}},
        {"--cut-distance", {"--cut-distance", "7"}},
        {"--environment-intensity", {"--environment-intensity", "2"}},
        {"--environment-rotation", {"--environment-rotation", "45"}},
        {"--error", {"--method", "truth", "--error", "0.1"}},
        {"--ev", {"--ev", "1"}},
        {"--exposure", {"--exposure", "1"}},
        {"--focus", {"--method", "truth", "--focus", "3"}},
        {"--focus-entity", {"--method", "truth", "--focus-entity", "x"}},
        {"--fps", {"--fps", "25"}},
        {"--frame-fit", {"--frame-fit", "height"}},
        {"--fstop", {"--method", "truth", "--fstop", "8"}},
        {"--instants", {"--method", "accumulate", "--instants", "auto"}},
        {"--loop", {"--loop"}},
        {"--max-blur", {"--max-blur", "4"}},
        {"--max-step", {"--method", "accumulate", "--instants", "auto", "--max-step", "2"}},
        {"--method", {"--method", "gather"}},
        {"--object-blur", {"--object-blur", "0.5"}},
        {"--particles", {"--particles", "off"}},
        {"--phase", {"--phase", "start"}},
        {"--pixel", {"--method", "truth", "--pixel", "box"}},
        {"--rays", {"--rays", "none"}},
        {"--preset", {"--preset", "paper"}},
        {"--reference-fps", {"--shutter-mode", "capped", "--reference-fps", "30"}},
        {"--response", {"--response", "triangle"}},
        {"--samples", {"--samples", "3"}},
        {"--seed", {"--seed", "3"}},
        {"--set", {"--set", "history=false"}},
        {"--shadow-distance", {"--shadow-distance", "7"}},
        {"--shadow-instants", {"--shadow-instants", "7"}},
        {"--shadow-map-size", {"--shadow-map-size", "128"}},
        {"--shadows", {"--shadows", "sharp"}},
        {"--shutter-angle", {"--shutter-angle", "90"}},
        {"--shutter-mode", {"--shutter-mode", "angle"}},
        {"--size", {"--size", "8x8"}},
        {"--sky", {"--sky", "2.5"}},
        {"--time", {"--time", "1"}},
        {"--tonemap", {"--tonemap", "none"}},
        {"--unlit", {"--unlit"}}};
    const std::map<std::string, Words> doesNot = {
        {"--advice", {"--advice"}},
        {"--bit-depth", {}},                      // needs a film
        {"--allow-outside", {"--allow-outside"}}, // identified by content
        {"--codec", {}},                          // needs a film
        {"--device", {"--device", "llvmpipe"}},
        {"--dry-run", {"--dry-run"}},
        {"--dump-graph", {"--dump-graph"}},
        {"--environment", {"--environment", "e.hdr"}}, // identified by content
        {"--explain", {"--explain"}},
        {"--ffmpeg", {}},                             // needs a film
        {"--flythrough", {"--flythrough", "f.json"}}, // identified by content
        {"--frames", {"--frames", "0:3"}},
        {"--framing-time", {"--framing-time", "1"}}, // identified as resolved
        {"--hash-passes", {"--hash-passes", "h.json"}},
        {"--keep-frames", {}}, // needs a film
        {"--out", {}},
        {"--part", {}}, // needs frames
        {"--repeat", {"--repeat", "3"}},
        {"--restart", {"--restart"}},
        {"--stats", {"--stats", "s.json"}},
        {"--timecode", {}}, // needs a film
        {"--validate", {"--validate"}}};
    std::set<std::string> fingerprints = {plain};
    for (const auto& [option, words] : matters)
        EXPECT_TRUE(fingerprints.insert(describe(words)).second) << option;
    for (const auto& [option, words] : doesNot)
        EXPECT_EQ(describe(words), plain) << option;
    // A new option must be put in one of the lists.
    CLI::App app;
    RenderArguments arguments;
    defineRenderOptions(app, arguments);
    for (const CLI::Option* option : app.get_options()) {
        const std::string name = option->get_name();
        if (name.starts_with("--") && name != "--help") {
            EXPECT_TRUE(matters.contains(name) || doesNot.contains(name)) << name;
        }
    }
}

} // namespace
} // namespace shutter::game
