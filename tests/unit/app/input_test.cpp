// SPDX-License-Identifier: MIT
// Input, scripts of it, cameras by hand, the clock of steps, and what windows show.
#include "engine/app/camera_control.h"
#include "engine/app/input.h"
#include "engine/app/input_script.h"
#include "engine/app/step_clock.h"
#include "engine/app/window_output.h"
#include "tests/support/outcomes.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <random>
#include <set>
#include <string>

namespace shutter::app {
namespace {

using math::dvec3;

TEST(Input, EveryKeyHasANameOfItsOwn) {
    std::set<std::string_view> names;
    for (size_t i = 0; i < kKeyCount; ++i) {
        const Key key = static_cast<Key>(i);
        EXPECT_FALSE(nameOf(key).empty()) << i;
        EXPECT_EQ(findKey(nameOf(key)), key);
        names.insert(nameOf(key));
    }
    EXPECT_EQ(names.size(), kKeyCount);
    EXPECT_FALSE(findKey("W"));
    EXPECT_FALSE(findKey(""));
}

TEST(Input, AKeyIsPressedInOneFrameAndHeldUntilItIsReleasedOrTheFocusIsLost) {
    InputCollector collector;
    collector.setKey(Key::W, true);
    collector.setKey(Key::W, true); // repeats
    const InputState first = collector.take();
    EXPECT_TRUE(first.wasPressed(Key::W));
    EXPECT_TRUE(first.isDown(Key::W));
    const InputState second = collector.take();
    EXPECT_FALSE(second.wasPressed(Key::W));
    EXPECT_TRUE(second.isDown(Key::W));
    collector.setKey(Key::W, false);
    EXPECT_FALSE(collector.take().isDown(Key::W));
    // A tap within a frame is seen.
    collector.setKey(Key::M, true);
    collector.setKey(Key::M, false);
    const InputState tapped = collector.take();
    EXPECT_TRUE(tapped.wasPressed(Key::M));
    EXPECT_FALSE(tapped.isDown(Key::M));
    collector.setKey(Key::W, true);
    collector.setButton(MouseButton::Left, true);
    collector.releaseAll();
    const InputState lost = collector.take();
    EXPECT_TRUE(lost.down.none());
    EXPECT_TRUE(lost.buttons.none());
}

TEST(Input, ThePointerMovesFromWhereItWasAndKeysThatPullApartCancel) {
    InputCollector collector;
    collector.movePointer({300.0, 200.0});
    EXPECT_EQ(collector.take().pointerMovePx, math::dvec2(0.0));
    collector.movePointer({310.0, 195.0});
    collector.movePointer({320.0, 190.0});
    EXPECT_EQ(collector.take().pointerMovePx, math::dvec2(20.0, -10.0));
    EXPECT_EQ(collector.take().pointerMovePx, math::dvec2(0.0));
    InputCollector keys;
    keys.setKey(Key::A, true);
    EXPECT_EQ(axisOf(keys.take(), Key::A, Key::D), -1.0);
    keys.setKey(Key::D, true);
    EXPECT_EQ(axisOf(keys.take(), Key::A, Key::D), 0.0);
}

TEST(Input, PadButtonsArePressedOnceAndASticksRestIsZeroAndItsEndOne) {
    InputCollector collector;
    Gamepad pad;
    pad.present = true;
    pad.down.set(static_cast<size_t>(PadButton::A));
    collector.setPad(pad);
    EXPECT_TRUE(collector.take().wasPressed(PadButton::A));
    collector.setPad(pad);
    EXPECT_FALSE(collector.take().wasPressed(PadButton::A));
    EXPECT_EQ(applyDeadZone(0.11), 0.0);
    EXPECT_EQ(applyDeadZone(-0.12), 0.0);
    EXPECT_NEAR(applyDeadZone(0.1201), 0.0, 1e-3);
    EXPECT_EQ(applyDeadZone(1.0), 1.0);
    EXPECT_EQ(applyDeadZone(-1.2), -1.0);
    EXPECT_EQ(applyDeadZone(std::numeric_limits<double>::quiet_NaN()), 0.0);
}

class InputScriptFile : public testing::Test {
  protected:
    core::Result<InputScript> read(const std::string& text) {
        std::ofstream(mPath) << text;
        return readInputScript(mPath);
    }

    void expectRefused(const std::string& event, const std::string& reported) {
        const auto script = read("{\"version\": 1, \"events\": [\n" + event + "]}");
        test::expectRefused(script, reported);
        test::expectRefused(script, ":2");
    }

    test::TempFolder mFolder;
    std::filesystem::path mPath = mFolder.path() / "input_script.json";
};

TEST_F(InputScriptFile, EventsComeInTheFrameOfTheirTime) {
    auto script = test::valueOf(read(R"({"version": 1, "frameSeconds": 0.1, "events": [
        {"time": 0, "key": "w", "action": "press"},
        {"time": 0.1, "pointer": [0.25, 0.5]},
        {"time": 0.1, "key": "m"},
        {"time": 0.3, "resize": [320, 200]},
        {"time": 0.3, "window": "quit"}]})"));
    ScriptPlayer player(std::move(script));
    EXPECT_EQ(player.countFrames(), 4u);
    InputCollector input;
    EXPECT_EQ(player.takeFrame(input, {400, 200}).size(), 1u);
    EXPECT_TRUE(input.take().isDown(Key::W));
    EXPECT_EQ(player.takeFrame(input, {400, 200}).size(), 2u);
    const InputState second = input.take();
    EXPECT_EQ(second.pointerPx, math::dvec2(100.0, 100.0));
    EXPECT_TRUE(second.wasPressed(Key::M));
    EXPECT_TRUE(second.isDown(Key::W));
    EXPECT_TRUE(player.takeFrame(input, {400, 200}).empty());
    EXPECT_FALSE(player.isOver());
    const auto last = player.takeFrame(input, {400, 200});
    ASSERT_EQ(last.size(), 2u);
    EXPECT_EQ(std::get<ResizeEvent>(last[0].what).size, math::uvec2(320, 200));
    EXPECT_EQ(std::get<WindowAction>(last[1].what), WindowAction::Quit);
    EXPECT_TRUE(player.isOver());
}

TEST_F(InputScriptFile, SticksStayWhereTheyWerePut) {
    auto script =
        test::valueOf(read(R"({"version": 1, "events": [{"time": 0, "leftStick": [-1, 0.5]}]})"));
    ScriptPlayer player(std::move(script));
    InputCollector input;
    (void)player.takeFrame(input, {1, 1});
    (void)input.take();
    (void)player.takeFrame(input, {1, 1});
    EXPECT_EQ(input.take().pad.leftStick, math::dvec2(-1.0, 0.5));
}

TEST_F(InputScriptFile, WrongEventsAreRefusedByLineAndField) {
    expectRefused(R"({"time": 0, "key": "nokey"})", "events[0].key");
    expectRefused(R"({"time": -1, "key": "w"})", "events[0].time");
    expectRefused(R"({"time": 0})", "must have one of");
    expectRefused(R"({"time": 0, "key": "w", "wheel": 1})", "must have one of");
    expectRefused(R"({"time": 0, "wheel": 1, "action": "tap"})", "events[0].action");
    expectRefused(R"({"time": 0, "resize": [0, 5]})", "events[0].resize[0]");
    expectRefused(R"({"time": 0, "resize": [5]})", "events[0].resize");
    expectRefused(R"({"time": 0, "pointer": [0.5, 1.5]})", "events[0].pointer[1]");
    expectRefused(R"({"time": 0, "window": "close"})", "events[0].window");
    expectRefused(R"({"time": 0, "keys": "w"})", "keys");
}

TEST_F(InputScriptFile, AScreenshotIsADisplayPictureBelowTheWorkingFolder) {
    const auto shoot = [](const std::string& file) {
        return "{\"time\": 0, \"screenshot\": \"" + file + "\"}";
    };
    EXPECT_TRUE(read("{\"version\": 1, \"events\": [" + shoot("sub/a.png") + "]}"));
    expectRefused(shoot("a.bmp"), "events[0].screenshot: 'a.bmp' has the unknown extension");
    expectRefused(shoot("a.exr"), "events[0].screenshot");
    for (const char* outside : {"../a.png", "sub/../../a.png", "/a.png"}) {
        expectRefused(shoot(outside), "leaves the folder");
        std::ofstream(mPath) << "{\"version\": 1, \"events\": [" << shoot(outside) << "]}";
        EXPECT_TRUE(readInputScript(mPath, io::Reach::Anywhere)) << outside;
    }
}

TEST_F(InputScriptFile, TimesMustNotFallBack) {
    const char* back =
        R"({"version": 1, "events": [{"time": 1, "key": "w"}, {"time": 0.5, "key": "w"}]})";
    test::expectRefused(read(back), "events[1]");
    EXPECT_FALSE(read(R"({"version": 1, "events": []})"));
    EXPECT_FALSE(read(R"({"version": 2, "events": [{"time": 0, "key": "w"}]})"));
    EXPECT_FALSE(read(R"({"version": 1, "frameSeconds": 0, "events": [{"time": 0, "key": "w"}]})"));
}

dvec3 aheadOf(const math::Transform& placement) {
    return placement.rotation * dvec3(0, 0, -1);
}

TEST(CameraControl, AnOrbitPointsAtItsTarget) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 100; ++i) {
        OrbitView view{{unit(random), unit(random), unit(random)}, 1.5 + unit(random)};
        view.yaw = 3.0 * unit(random);
        view.pitch = 1.5 * unit(random);
        const math::Transform placement = placementOf(view);
        const dvec3 target = placement.translation + aheadOf(placement) * view.distance;
        EXPECT_NEAR(glm::distance(target, view.target), 0.0, 1e-12);
        const OrbitView back = makeOrbit(placement, view.distance);
        EXPECT_NEAR(glm::distance(back.target, view.target), 0.0, 1e-9);
        EXPECT_NEAR(back.yaw, view.yaw, 1e-9);
        EXPECT_NEAR(back.pitch, view.pitch, 1e-9);
    }
}

TEST(CameraControl, FlyingAheadGoesWhereTheCameraPoints) {
    FlyView view{{1.0, 2.0, 3.0}, 0.7, 0.3, 2.0};
    const math::Transform before = placementOf(view);
    InputState input;
    input.down.set(static_cast<size_t>(Key::W));
    steer(view, input, 0.5, 720.0);
    const dvec3 expected = before.translation + aheadOf(before);
    EXPECT_NEAR(glm::distance(view.position, expected), 0.0, 1e-12);
    input.down.set(static_cast<size_t>(Key::Shift));
    steer(view, input, 0.5, 720.0);
    EXPECT_NEAR(glm::distance(view.position, before.translation), 5.0, 1e-12);
}

TEST(CameraControl, DraggingRightTurnsToTheRightNeverOverTheTopAndTheWheelStopsShortOfTheTarget) {
    FlyView view;
    InputState input;
    input.buttons.set(static_cast<size_t>(MouseButton::Right));
    input.pointerMovePx = {50.0, 0.0};
    steer(view, input, 0.0, 500.0);
    EXPECT_GT(aheadOf(placementOf(view)).x, 0.1);
    input.pointerMovePx = {0.0, -1e6};
    steer(view, input, 0.0, 500.0);
    EXPECT_DOUBLE_EQ(view.pitch, kMaxPitch);
    OrbitView orbit;
    InputState wheel;
    wheel.wheel = 3.0;
    steer(orbit, wheel, 0.0, 500.0);
    EXPECT_LT(orbit.distance, 0.7);
    wheel.wheel = 1e6;
    steer(orbit, wheel, 0.0, 500.0);
    EXPECT_GT(orbit.distance, 0.0);
}

constexpr double kStep = 1.0 / 120.0;

TEST(StepClock, TheDrawnTimeIsNeverAheadOfTheSimulatedTimeAndFramesOfWholeStepsTakeJustThese) {
    StepClock clock(kStep);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> wall(0.0, 0.05);
    uint64_t steps = 0;
    double last = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const FrameTime frame = clock.advance(wall(random));
        steps += frame.steps;
        EXPECT_LE(frame.seconds, double(steps) * kStep + 1e-7);
        EXPECT_GT(frame.seconds, (double(steps) - 1.0) * kStep - 1e-7);
        EXPECT_GE(frame.seconds, last);
        last = frame.seconds;
    }
    StepClock whole(kStep);
    for (int i = 0; i < 10'000; ++i)
        ASSERT_EQ(whole.advance(4.0 * kStep).steps, 4u) << i;
}

TEST(StepClock, APausedGameStandsAndKeepsItsFrame) {
    StepClock clock(kStep);
    (void)clock.advance(1.0 / 60.0);
    clock.setPaused(true);
    const FrameTime paused = clock.advance(1.0);
    EXPECT_EQ(paused.steps, 0u);
    EXPECT_DOUBLE_EQ(paused.seconds, 1.0 / 60.0);
    EXPECT_DOUBLE_EQ(paused.duration, 1.0 / 60.0); // its blur remains visible
    clock.stepOnce(1.0 / 60.0);
    EXPECT_EQ(clock.advance(1.0).steps, 2u);
    EXPECT_EQ(clock.advance(1.0).steps, 0u);
}

TEST(StepClock, SlowMotionShortensTheFrameAndAHitchIsNotMadeUpFor) {
    StepClock clock(kStep);
    clock.setSpeed(0.25);
    EXPECT_DOUBLE_EQ(clock.advance(0.04).duration, 0.01);
    clock.setSpeed(0.0);
    EXPECT_EQ(clock.speed(), 0.01);
    StepClock hitched(kStep);
    EXPECT_EQ(hitched.advance(60.0).steps, 30u);
    EXPECT_EQ(hitched.advance(-1.0).steps, 0u);
    EXPECT_EQ(hitched.advance(std::numeric_limits<double>::quiet_NaN()).steps, 0u);
    EXPECT_EQ(hitched.advance(std::numeric_limits<double>::infinity()).steps, 30u);
}

TEST(FitPicture, AFittedPictureIsCentredKeepsItsShapeAndFillsTheWindowUpToRounding) {
    const PixelRect wide = fitPicture({1280, 720}, {1280, 1000});
    EXPECT_EQ(wide.origin, math::dvec2(0.0, 140.0));
    EXPECT_EQ(wide.extent, math::dvec2(1280.0, 720.0));
    const PixelRect tall = fitPicture({100, 200}, {300, 100});
    EXPECT_EQ(tall.origin, math::dvec2(125.0, 0.0));
    EXPECT_EQ(tall.extent, math::dvec2(50.0, 100.0));
    // Half of 961 x 541, rounded.
    const PixelRect rect = fitPicture({481, 271}, {961, 541});
    EXPECT_EQ(rect.origin, math::dvec2(0.0));
    EXPECT_EQ(rect.extent, math::dvec2(961.0, 541.0));
    EXPECT_EQ(fitPicture({1, 1}, {1, 1}).extent, math::dvec2(1.0));
}

} // namespace
} // namespace shutter::app
