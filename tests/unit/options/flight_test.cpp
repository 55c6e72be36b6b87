// SPDX-License-Identifier: MIT
// Flythroughs by options, and which options a picture depends on.
#include "game/options/option_rows.h"
#include "game/options/render_arguments.h"
#include "game/shot/shot.h"
#include "tests/support/outcomes.h"
#include "tests/support/rows.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/options/command_words.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

namespace shutter::game {
namespace {

class Flight : public testing::Test {
  protected:
    Flight() {
        write(R"({"version": 1, "fps": 10, "keys": [
            {"time": 0.25, "position": [0, 0, 1], "lookAt": [0, 0, 0],
             "shutter": {"exposure": 0.125}},
            {"time": 0.6, "position": [0, 0, 2], "lookAt": [0, 0, 0],
             "shutter": {"shutterAngle": 90, "phase": "start"}}]})");
        mArguments.scene = "scene.glb";
    }

    void write(const std::string& text) {
        mArguments.flythrough = mFolder.write("flight.json", text).string();
    }

    [[nodiscard]] ShotOptions load() const {
        ShotOptions options = test::valueOf(interpret(mArguments));
        test::expectDone(loadFlythrough(mArguments, options));
        return options;
    }

    void refuse(const std::string& sentence) const {
        ShotOptions options = test::valueOf(interpret(mArguments));
        test::expectRefused(loadFlythrough(mArguments, options), sentence);
    }

    test::TempFolder mFolder;
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

TEST_F(Flight, FlightsWithoutATimeForEachFrameOrWithTooManyAreRefused) {
    write(R"({"version": 1, "fps": 1000, "keys": [
        {"time": 0, "position": [0, 0, 1], "lookAt": [0, 0, 0]},
        {"time": 1000, "position": [0, 0, 1], "lookAt": [0, 0, 0]}]})");
    refuse("--flythrough: 1000001 frames are too many");
    write(R"({"version": 1, "fps": 10, "keys": [
        {"time": 0, "position": [0, 0, 1], "lookAt": [0, 0, 0], "timeScale": 1000}]})");
    mArguments.fps = 1.0e-3;
    mArguments.frames = "0:1001";
    refuse("timeScale");
    mArguments.flythrough = "clip:";
    test::expectRefused(interpret(mArguments), "--flythrough clip:");
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
    EXPECT_EQ(test::valueOf(chooseClipCamera(world, options)), rider);
    EXPECT_EQ(world.playback.activeClips, (std::vector<bool>{true, true, false}));
    ASSERT_TRUE(planClipFrames(world, options).ok());
    EXPECT_EQ(options.frameTimes.size(), 13u); // 0 to 12 at 24 a second
    options.camera = "0";
    EXPECT_FALSE(chooseClipCamera(world, options).ok());
    options.camera.clear();
    options.flythroughClip = "tilt";
    test::expectRefused(chooseClipCamera(world, options), "clip:tilt");
}

// An option and its value, then what it needs.
constexpr const char* kMatters =
    "--aa taa|--ambient 1,1,1|--aov motion|--background 1,1,1|--bloom 0.1|--bloom-knee 0.1|"
    "--bloom-threshold 2|--budget 8|--camera x|--camera-rotation-blur 0.5|"
    "--camera-translation-blur 0.5|--clip x|--cut-angle 7|--cut-detection off|--cut-distance 7|"
    "--environment-intensity 2|--environment-rotation 45|--error 0.1 --method truth|--ev 1|"
    "--exposure 1|--focus 3 --method truth|--focus-entity x --method truth|--fps 25|"
    "--frame-fit height|--fstop 8 --method truth|--instants auto --method accumulate|--loop|"
    "--max-blur 4|--max-step 2 --method accumulate --instants auto|--method gather|"
    "--object-blur 0.5|--particles off|--phase start|--pixel box --method truth|--rays none|"
    "--preset paper|--reference-fps 30 --shutter-mode capped|--response triangle|--samples 3|"
    "--seed 3|--set history=false|--shadow-distance 7|--shadow-instants 7|"
    "--shadow-map-size 128|--shadows sharp|--shutter-angle 90|--shutter-mode angle|--size 8x8|"
    "--sky 2.5|--time 1|--tonemap none|--unlit|--response trapezoid:0.1,0.2|"
    "--shutter-mode capped";

constexpr const char* kMattersNot =
    "--advice|--device llvmpipe|--dry-run|--dump-graph|--explain|--frames 0:3|--hash-passes h.json|"
    "--repeat 3|--restart|--stats s.json|--validate|"
    // The content of these files counts, and what a time of framing chooses.
    "--allow-outside|--environment e.hdr|--flythrough f.json|--framing-time 1";

/// Which need frames or a film, or are where the picture goes.
constexpr const char* kNotAlone =
    "--bit-depth|--codec|--ffmpeg|--keep-frames|--out|--part|--timecode";

TEST(Fingerprint, TheFingerprintHasExactlyThePicturesInputs) {
    const auto describe = [](Words words) {
        words.insert(words.begin(), {"scene.glb", "--out", "f_%d.png"});
        RenderArguments arguments;
        test::expectDone(parseWords(words, [&](CLI::App& command) {
            defineRenderOptions(command, arguments);
        }));
        return test::valueOf(interpret(arguments)).fingerprint;
    };
    const std::string plain = describe({});
    std::set<std::string> fingerprints = {plain};
    std::set<std::string> listed = {"--help"};
    for (const std::string& name : test::rowsOf(kNotAlone))
        listed.insert(name);
    for (const std::string& row : test::rowsOf(kMattersNot)) {
        const Words words = splitAt(row, ' ');
        EXPECT_EQ(describe(words), plain) << row;
        listed.insert(words.front());
    }
    for (const std::string& row : test::rowsOf(kMatters)) {
        const Words words = splitAt(row, ' ');
        EXPECT_TRUE(fingerprints.insert(describe(words)).second) << row;
        listed.insert(words.front());
    }
    // A new option must be put in one of the lists.
    CLI::App app;
    RenderArguments arguments;
    defineRenderOptions(app, arguments);
    for (const CLI::Option* option : app.get_options())
        if (option->get_name().starts_with("--")) {
            EXPECT_TRUE(listed.contains(option->get_name())) << option->get_name();
        }
}

} // namespace
} // namespace shutter::game
