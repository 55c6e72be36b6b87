// SPDX-License-Identifier: MIT
// Autofocus: how it eases, and what it does where there is nothing to focus on.
#include "engine/scene/auto_focus.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"
#include "engine/scene/lens.h"
#include "engine/scene/path.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace shutter::scene {
namespace {

constexpr double kHalfLife = 0.2;
constexpr double kNear = 0.5;
constexpr double kOwn = 10.0; ///< focus distance of the lens itself

class AutoFocusing : public testing::Test {
  protected:
    AutoFocusing() : mCamera(mWorld.registry.create()), mTarget(mWorld.registry.create()) {
        mWorld.registry.add(mCamera, Camera{.near = kNear});
        mWorld.registry.add(mCamera, LocalTransform{});
        mWorld.registry.add(mCamera, CameraLens{.fStop = 2.0, .focusDistance = kOwn});
        mWorld.registry.add(mCamera, AutoFocus{mTarget, kHalfLife});
        put({0, 0, -4});
    }

    void put(const math::dvec3& place) {
        mWorld.registry.add(mTarget, LocalTransform{{.translation = place}});
    }

    /// Keys of the target's way, as a simulation records them.
    void move(std::vector<PathKey> keys) {
        for (PathKey& key : keys)
            key.rotation = math::dquat(1.0, 0.0, 0.0, 0.0);
        mWorld.registry.add(mTarget, PathMotion{std::move(keys), PathInterpolation::Linear});
    }

    void moveAway() { move({{0.0, {0, 0, -2}}, {1.0, {1, 0, -9}}, {2.0, {0, 0, -1}}}); }

    /// Begins at time 0 as if nothing had been focused on.
    void restart() {
        mWorld.registry.remove<FocusTrail>(mCamera);
        advanceAutoFocus(mWorld, 0.0);
    }

    [[nodiscard]] double at(double seconds) const {
        return lensAt(mWorld, mCamera, seconds).focusDistance;
    }

    void advance(double from, double to, double fps = 60.0) {
        for (int i = 0; from + i / fps <= to + 1e-9; ++i)
            advanceAutoFocus(mWorld, from + i / fps);
    }

    World mWorld;
    ecs::Entity mCamera;
    ecs::Entity mTarget;
};

TEST_F(AutoFocusing, HalfOfTheWayOfTheInverseIsGoneInAHalfLife) {
    EXPECT_EQ(at(0.0), kOwn) << "the system did not run";
    advanceAutoFocus(mWorld, 0.0);
    EXPECT_EQ(at(0.0), 4.0) << "it begins in focus";
    put({3, -2, -1}); // the distance is that along the axis
    advance(0.0, 10 * kHalfLife);
    for (int i = 0; i <= 10; ++i)
        EXPECT_NEAR(1.0 / at(i * kHalfLife), 1.0 - 0.75 * std::exp2(-i), 1e-12) << i;
    mWorld.registry.get<AutoFocus>(mCamera).halfLife = 0.0;
    put({0, 0, -2});
    advanceAutoFocus(mWorld, 10 * kHalfLife + 1.0 / kFocusStepsPerSecond);
    EXPECT_EQ(at(100.0), 2.0) << "at once, and after the last step it stays";
    mWorld.registry.add(mCamera, FocusMotion{{{0.0, 1.5, {}, false}}});
    EXPECT_EQ(at(0.0), 1.5) << "keys go before it";
    mWorld.registry.add(mCamera, LensOverride{.focusDistance = 2.5});
    EXPECT_EQ(at(0.0), 2.5) << "and a viewer before all";
}

TEST_F(AutoFocusing, FramesOfAnyRateSeeTheSameLensToTheBit) {
    moveAway();
    std::vector<double> seen;
    for (const double fps : {24.0, 30.0, 60.0, 144.0, 7.0}) {
        restart();
        advance(0.0, 2.0, fps);
        advanceAutoFocus(mWorld, 2.0);
        std::vector<double> lenses;
        for (double seconds = 0.5; seconds <= 2.0; seconds += 0.013)
            lenses.push_back(at(seconds));
        if (seen.empty())
            seen = lenses;
        EXPECT_EQ(lenses, seen) << fps;
    }
}

TEST_F(AutoFocusing, AReplayedFrameDoesNotDependOnTheFramesBeforeIt) {
    move({{0.0, {0, 0, -2}}, {1.0, {1, 0, -9}}, {1300.0, {0, 0, -1}}});
    const std::vector<double> times{0.3, 599.99, 600.01, 1199.999, 1200.001, 0.7, 1000.0};
    for (const double seconds : times) {
        replayAutoFocus(mWorld, seconds);
        const double inOrder = at(seconds);
        const double before = at(seconds - 0.05);
        mWorld.registry.remove<FocusTrail>(mCamera);
        replayAutoFocus(mWorld, seconds);
        EXPECT_EQ(at(seconds), inOrder) << seconds;
        EXPECT_EQ(at(seconds - 0.05), before) << seconds;
    }
    mWorld.registry.remove<FocusTrail>(mCamera);
    advance(0.0, 0.7, 50.0);
    const double played = at(0.7);
    replayAutoFocus(mWorld, 0.7);
    EXPECT_EQ(at(0.7), played) << "a session that began at time 0";
    replayAutoFocus(mWorld, -5.0);
    EXPECT_EQ(at(-5.0), 2.0) << "before time 0 nothing eases";
}

TEST_F(AutoFocusing, AReplayReachesAsFarAsScalesOfTheBlurDo) {
    moveAway();
    CameraShutter shutter;
    shutter.mode = ShutterMode::Physical;
    shutter.exposureSeconds = 0.2;
    shutter.phase = ShutterPhase::Start;
    shutter.cameraRotationScale = 2.0;
    const auto replay = [&](double seconds) {
        const ExposureInterval exposure = computeExposure(shutter, seconds);
        replayAutoFocus(mWorld, mCamera, exposure);
        return ExposureMotion(mWorld, mCamera, exposure).cameraLens(1.0).focusDistance;
    };
    const double alone = replay(0.5);
    replay(1.0);
    EXPECT_EQ(replay(0.5), alone) << "after a later one";
    EXPECT_DOUBLE_EQ(at(0.9), alone) << "twice as far as the shutter is open";
}

TEST_F(AutoFocusing, AReplayBeginsAnewWhereTheAutofocusIsAnother) {
    moveAway();
    const ecs::Entity other = mWorld.registry.create();
    mWorld.registry.add(other, LocalTransform{{.translation = {0, 0, -3}}});
    for (const AutoFocus& changed : {AutoFocus{mTarget, 0.0}, AutoFocus{other, kHalfLife}}) {
        mWorld.registry.add(mCamera, AutoFocus{mTarget, kHalfLife});
        replayAutoFocus(mWorld, 1.0);
        mWorld.registry.add(mCamera, changed);
        replayAutoFocus(mWorld, 1.0);
        const double after = at(1.0);
        mWorld.registry.remove<FocusTrail>(mCamera);
        replayAutoFocus(mWorld, 1.0);
        EXPECT_EQ(after, at(1.0)) << changed.halfLife;
    }
}

TEST_F(AutoFocusing, WhatIsNotValidIsRefusedAndDoesNotStay) {
    EXPECT_TRUE(validateAutoFocus({}).ok());
    for (const double bad : {-1.0, 1001.0, kNan}) {
        const core::Status valid = validateAutoFocus({mTarget, bad});
        ASSERT_FALSE(valid.ok()) << bad;
        EXPECT_NE(valid.error().message.find("halfLife"), std::string::npos);
    }
    for (const double bad : {kNan, -1.0}) {
        mWorld.registry.get<AutoFocus>(mCamera).halfLife = kHalfLife;
        restart();
        mWorld.registry.get<AutoFocus>(mCamera).halfLife = bad;
        advance(0.0, 1.0);
        EXPECT_EQ(at(1.0), 4.0) << bad;
        mWorld.registry.get<AutoFocus>(mCamera).halfLife = kHalfLife;
        put({0, 0, -2});
        advance(1.0, 9.0);
        EXPECT_NEAR(at(9.0), 2.0, 1e-9) << bad;
        put({0, 0, -4});
    }
    for (const double bad : {0.0, kNan, -1.0}) {
        mWorld.registry.remove<FocusTrail>(mCamera);
        mWorld.registry.get<CameraLens>(mCamera).focusDistance = bad;
        put({0, 0, 1});
        advanceAutoFocus(mWorld, 0.0);
        EXPECT_EQ(at(0.0), CameraLens{}.focusDistance) << bad;
        put({0, 0, -4});
        advance(0.0, 9.0);
        EXPECT_NEAR(at(9.0), 4.0, 1e-9) << bad;
    }
}

TEST_F(AutoFocusing, ATargetBehindTheCameraOrBeforeTheNearPlaneLeavesTheDistance) {
    advanceAutoFocus(mWorld, 0.0);
    for (const double z : {3.0, 0.0, -0.999 * kNear}) {
        put({0, 0, z});
        advance(0.0, 1.0);
        EXPECT_EQ(at(1.0), 4.0) << z;
        restart();
        EXPECT_EQ(at(0.0), kOwn) << "there was no distance before";
        put({0, 0, -4});
        restart();
    }
    put({0, 0, -kNear});
    advance(0.0, 20.0);
    EXPECT_NEAR(at(20.0), kNear, 1e-9) << "on the near plane it is seen";
}

TEST_F(AutoFocusing, ATargetThatIsDestroyedOrNowhereLeavesTheDistance) {
    advanceAutoFocus(mWorld, 0.0);
    for (const double bad : {kNan, kInfinity}) {
        put({0, 0, -bad});
        advance(0.0, 0.5);
        EXPECT_EQ(at(0.5), 4.0) << bad;
    }
    put({0, 0, -4});
    despawn(mWorld, mTarget);
    advance(0.5, 1.0);
    EXPECT_EQ(at(1.0), 4.0);
    const ecs::Entity other = mWorld.registry.create(); // in the slot of the dead one
    mWorld.registry.add(other, LocalTransform{{.translation = {0, 0, -1}}});
    advance(1.0, 2.0);
    EXPECT_EQ(at(2.0), 4.0) << "another entity is no target";
    mWorld.registry.get<AutoFocus>(mCamera).target = ecs::kNullEntity;
    advance(2.0, 3.0);
    EXPECT_EQ(at(3.0), 4.0);
}

TEST_F(AutoFocusing, FarAwayAndVeryNearStayValid) {
    mWorld.registry.get<Camera>(mCamera).near = 1.0e-6;
    for (const double distance : {1.0e12, 1.0e-5}) {
        mWorld.registry.remove<FocusTrail>(mCamera);
        put({0, 0, -distance});
        advance(0.0, 1.0);
        EXPECT_TRUE(validate(lensAt(mWorld, mCamera, 1.0)).ok()) << distance;
        EXPECT_NEAR(at(1.0), distance > 1.0 ? kFarthestFocus : kNearestFocus, 1e-6);
    }
}

TEST_F(AutoFocusing, ATargetThatCrossesTheCameraAndComesBackIsEasedTo) {
    move({{0.0, {0, 0, -2}}, {1.0, {0, 0, 2}}, {2.0, {0, 0, -2}}});
    advance(0.0, 6.0);
    double last = at(0.0);
    double nearest = last;
    for (double seconds = 0.0; seconds <= 6.0; seconds += 1.0 / 480.0) {
        const double now = at(seconds);
        ASSERT_TRUE(std::isfinite(now)) << seconds;
        // 1/m that a step may take of the way to the near plane.
        ASSERT_LT(std::abs(1.0 / now - 1.0 / last), 0.02) << seconds;
        nearest = std::min(nearest, now);
        last = now;
    }
    EXPECT_GE(nearest, kNear);
    EXPECT_EQ(at(0.6), at(1.4)) << "behind the camera nothing changes";
    EXPECT_NEAR(at(6.0), 2.0, 1e-3);
}

TEST_F(AutoFocusing, ACutJumpsAtItsTimeAlsoWithinAStepAndAnnouncedLate) {
    advance(0.0, 1.0);
    put({0, 0, -2});
    const double cutAt = 1.0 + 0.3 / kFocusStepsPerSecond;
    cut(mWorld, mCamera, cutAt);
    advance(1.0, 1.1);
    EXPECT_EQ(at(cutAt - 1e-6), 4.0);
    EXPECT_EQ(at(cutAt), 2.0);
    EXPECT_EQ(at(1.1), 2.0);
    // During easing, announced after the step was taken.
    put({0, 0, -8});
    advance(1.1, 1.2);
    EXPECT_LT(at(1.2), 7.0);
    cut(mWorld, mCamera, 1.2 - 1e-4);
    advance(1.2, 1.25);
    EXPECT_EQ(at(1.25), 8.0);
    PathMotion path{
        {{0.0, {0, 0, 0}}, {1.5, {0, 0, 5}}, {1.503, {0, 0, 0}}}, PathInterpolation::Linear};
    for (PathKey& key : path.keys)
        key.rotation = math::dquat(1.0, 0.0, 0.0, 0.0);
    path.keys[2].cut = true;
    mWorld.registry.add(mCamera, std::move(path));
    replayAutoFocus(mWorld, 2.0);
    EXPECT_EQ(at(1.503), 8.0);
    EXPECT_GT(at(1.503 - 1e-6), 11.0) << "it held until the cut";
}

TEST_F(AutoFocusing, ItCostsNoMemoryThatGrowsAndGoesOnAfterAPause) {
    advance(0.0, 60.0, 30.0);
    EXPECT_LT(mWorld.registry.get<FocusTrail>(mCamera).inverses.size(), 1000u);
    EXPECT_EQ(at(0.0), at(60.0)) << "what was dropped is as the oldest step in memory";
    put({0, 0, -1});
    advanceAutoFocus(mWorld, 5000.0); // long after
    EXPECT_EQ(at(5000.0), 1.0);
    put({0, 0, -3});
    advanceAutoFocus(mWorld, 1.0); // a game that begins again
    EXPECT_EQ(at(1.0), 3.0);
    mWorld.registry.get<Camera>(mCamera).kind = CameraKind::Orthographic;
    advanceAutoFocus(mWorld, 2.0);
    EXPECT_EQ(lensAt(mWorld, mCamera, 2.0).fStop, 0.0);
}

} // namespace
} // namespace shutter::scene
