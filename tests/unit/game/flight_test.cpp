// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"
#include "game/flight.h"
#include "game/shot.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
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
        mArguments.out = "f_%d.png";
        mArguments.flythrough = mFile.string();
    }

    ~Flight() override { std::filesystem::remove(mFile); }

    void write(const std::string& text) const { ASSERT_TRUE(io::writeFileText(mFile, text).ok()); }

    [[nodiscard]] RenderOptions load() const {
        auto options = interpret(mArguments);
        EXPECT_TRUE(options.ok()) << (options.ok() ? "" : options.error().message);
        const core::Status loaded = loadFlythrough(mArguments, options.value());
        EXPECT_TRUE(loaded.ok()) << (loaded.ok() ? "" : loaded.error().message);
        return std::move(options).value();
    }

    std::filesystem::path mFile;
    RenderArguments mArguments;
};

TEST_F(Flight, AllFramesWithinItAreDrawnAtTheFilesRate) {
    const RenderOptions options = load();
    EXPECT_EQ(options.frameTimes, (std::vector<double>{3 / 10.0, 4 / 10.0, 5 / 10.0, 6 / 10.0}));
    EXPECT_EQ(options.firstFrame, 3);
    EXPECT_EQ(options.frameSeconds, 0.1);
    EXPECT_TRUE(options.isSequence);
    EXPECT_FALSE(options.flythroughHash.empty());
}

TEST_F(Flight, WhatIsTypedWins) {
    mArguments.fps = 4.0;
    mArguments.isFpsTyped = true;
    EXPECT_EQ(load().frameTimes, (std::vector<double>{0.25, 0.5}));
    EXPECT_EQ(load().frameSeconds, 0.25);
    mArguments.frames = "7:8";
    EXPECT_EQ(load().frameTimes, (std::vector<double>{1.75, 2.0}));
    mArguments.isFpsTyped = false;
    mArguments.fps = 24.0;
    EXPECT_EQ(load().frameTimes, (std::vector<double>{0.7, 0.8}));
    EXPECT_TRUE(load().isFlythroughShutter);
    mArguments.exposureSeconds = 0.5;
    EXPECT_FALSE(load().isFlythroughShutter);
}

TEST_F(Flight, AMomentIsOneFrame) {
    write(R"({"version": 1, "fps": 10, "keys": [
        {"time": 0.31, "position": [0, 0, 1], "lookAt": [0, 0, 0]}]})");
    EXPECT_EQ(load().frameTimes, std::vector<double>{4 / 10.0});
}

TEST_F(Flight, TooLongAFlightIsRefused) {
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
    RenderOptions options = load();
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
    RenderOptions options;
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

TEST(PictureOptions, TellWhatAPictureDependsOnAndNothingElse) {
    const auto describe = [](const std::vector<std::string>& more) {
        CLI::App app;
        RenderArguments arguments;
        defineRenderOptions(app, arguments);
        std::vector<std::string> words = {"scene.glb", "--out", "f.png"};
        words.insert(words.end(), more.begin(), more.end());
        std::reverse(words.begin(), words.end()); // as CLI11 takes them
        app.parse(words);
        return describePictureOptions(app);
    };
    const std::string plain = describe({});
    EXPECT_EQ(plain, "");
    for (const std::vector<std::string>& of :
         {std::vector<std::string>{"--samples", "3"},
          {"--unlit"},
          {"--set", "tileSize=8"},
          {"--size", "8x8"},
          {"--aov", "motion"},
          {"--exposure", "1"},
          {"--loop"},
          {"--camera", "x"},
          {"--rays", "none"}})
        EXPECT_NE(describe(of), plain) << of[0];
    for (const std::vector<std::string>& of :
         {std::vector<std::string>{"--frames", "0:3"},
          {"--stats", "s.json"},
          {"--explain"},
          {"--restart"},
          {"--device", "llvmpipe"},
          {"--repeat", "3"}})
        EXPECT_EQ(describe(of), plain) << of[0];
}

} // namespace
} // namespace shutter::game
