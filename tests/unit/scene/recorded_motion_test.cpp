// SPDX-License-Identifier: MIT
#include "engine/scene/exposure_motion.h"
#include "engine/scene/path.h"
#include "engine/scene/recorded_motion.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

namespace shutter::scene {
namespace {

using math::dquat;
using math::dvec3;
using math::Transform;

constexpr double kStep = 1.0 / 120.0;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Transform at(const dvec3& place, double radians = 0.0) {
    return {place, glm::angleAxis(radians, kUp)};
}

class RecordedMotionTest : public testing::Test {
  protected:
    RecordedMotionTest() {
        mCamera = mWorld.registry.create();
        mWorld.registry.add(mCamera, Camera{});
        mMover = mWorld.registry.create();
    }

    [[nodiscard]] dvec3 placeAt(double seconds) const {
        return dvec3(worldFromEntity(mWorld, mMover, seconds)[3]);
    }

    [[nodiscard]] const PathMotion& path() const {
        return std::as_const(mWorld).registry.get<PathMotion>(mMover);
    }

    [[nodiscard]] ExposureMotion exposureAt(double seconds, double exposureSeconds) const {
        CameraShutter shutter;
        shutter.exposureSeconds = exposureSeconds;
        return {mWorld, mCamera, computeExposure(shutter, seconds, exposureSeconds)};
    }

    World mWorld;
    ecs::Entity mCamera;
    ecs::Entity mMover;
};

TEST_F(RecordedMotionTest, AnExposureSeesTheStepsAsTheyWere) {
    recordMotion(mWorld, mMover, at({0, 0, 0}), 0.0);
    recordMotion(mWorld, mMover, at({1, 0, 0}), kStep);
    recordMotion(mWorld, mMover, at({1, 2, 0}), 2 * kStep);
    const ExposureMotion motion = exposureAt(2 * kStep, 2 * kStep);
    ASSERT_TRUE(motion.mayMove(mMover));
    const auto seen = [&](double s) { return dvec3(motion.worldFromEntity(mMover, s)[3]); };
    EXPECT_NEAR(glm::distance(seen(0.25), dvec3(0.5, 0, 0)), 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(seen(0.5), dvec3(1, 0, 0)), 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(seen(0.75), dvec3(1, 1, 0)), 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(seen(1.0), dvec3(1, 2, 0)), 0.0, 1e-12);
}

TEST_F(RecordedMotionTest, AWheelUnderATurningBodyIsExactBetweenSteps) {
    // 100 rad/s is 0.83 rad a step; the body drives a curve at the same time.
    const ecs::Entity wheel = mWorld.registry.create();
    mWorld.registry.add(wheel, Parent{mMover});
    const dquat axle = glm::angleAxis(std::acos(-1.0) / 2.0, dvec3(0, 0, 1));
    const auto wheelPose = [&](double seconds) {
        return Transform{{1, 0, 0}, axle * glm::angleAxis(100.0 * seconds, kUp)};
    };
    const auto bodyTurn = [](double seconds) { return glm::angleAxis(2.0 * seconds, kUp); };
    for (int i = 0; i <= 40; ++i) {
        recordMotion(mWorld, mMover, {dvec3(0.0), bodyTurn(i * kStep)}, i * kStep);
        recordMotion(mWorld, wheel, wheelPose(i * kStep), i * kStep);
    }
    const double between = 37.37 * kStep;
    const math::dmat4 expected = math::computeMatrix({dvec3(0.0), bodyTurn(between)}) *
                                 math::computeMatrix(wheelPose(between));
    const math::dmat4 actual = worldFromEntity(mWorld, wheel, between);
    for (int column = 0; column < 4; ++column)
        EXPECT_NEAR(glm::distance(actual[column], expected[column]), 0.0, 1e-9) << column;
}

TEST_F(RecordedMotionTest, KeepsItsReachAndNoMoreHoweverLongItRuns) {
    size_t most = 0;
    for (int i = 0; i <= 120 * 60; ++i) {
        recordMotion(mWorld, mMover, at({double(i), 0, 0}), i * kStep);
        most = std::max(most, path().keys.size());
    }
    EXPECT_TRUE(validatePath(path()).ok());
    EXPECT_LE(most, 2 * size_t(kRecordedSeconds / kStep) + 4);
    const double now = 7200 * kStep;
    EXPECT_NEAR(placeAt(now - kRecordedSeconds).x, 7200.0 - kRecordedSeconds / kStep, 1e-6);
    EXPECT_NEAR(placeAt(now - 0.3 * kStep).x, 7199.7, 1e-6);
}

TEST_F(RecordedMotionTest, WhatRestsCostsOneKeyAndIsNotNoted) {
    for (int i = 0; i <= 100; ++i)
        recordMotion(mWorld, mMover, at({std::min(i, 10) * 1.0, 0, 0}), i * kStep);
    EXPECT_EQ(path().keys.size(), 1u);
    EXPECT_FALSE(mayMove(mWorld, mMover));
    ecs::ChangeCursor cursor;
    (void)mWorld.registry.changesSince<PathMotion>(cursor);
    recordMotion(mWorld, mMover, at({10, 0, 0}), 101 * kStep);
    const ecs::Changes changes = mWorld.registry.changesSince<PathMotion>(cursor);
    EXPECT_FALSE(changes.all);
    EXPECT_TRUE(changes.entities.empty());
}

TEST_F(RecordedMotionTest, WhatRestedStartsFromTheStepBefore) {
    for (int i = 0; i <= 100; ++i)
        recordMotion(mWorld, mMover, at({5, 0, 0}), i * kStep);
    recordMotion(mWorld, mMover, at({6, 0, 0}), 101 * kStep);
    EXPECT_EQ(placeAt(99.5 * kStep).x, 5.0);
    EXPECT_NEAR(placeAt(100.5 * kStep).x, 5.5, 1e-9);
    EXPECT_TRUE(validatePath(path()).ok());
}

TEST_F(RecordedMotionTest, AJumpIsNoMotion) {
    recordMotion(mWorld, mMover, at({0, 0, 0}), 0.0);
    recordMotion(mWorld, mMover, at({1, 0, 0}), kStep);
    recordJump(mWorld, mMover, at({50, 0, 0}), 2 * kStep);
    EXPECT_EQ(placeAt(1.9 * kStep).x, 1.0);
    EXPECT_EQ(placeAt(2.0 * kStep).x, 50.0);
    EXPECT_FALSE(exposureAt(2 * kStep, kStep).mayMove(mMover));
    recordMotion(mWorld, mMover, at({51, 0, 0}), 3 * kStep);
    EXPECT_TRUE(exposureAt(3 * kStep, kStep).mayMove(mMover));
    EXPECT_FALSE(exposureAt(3 * kStep, 2 * kStep).mayMove(mMover));
}

TEST_F(RecordedMotionTest, ARestedThingThatJumpsOntoItsPlaceHasNoPastEither) {
    for (int i = 0; i <= 100; ++i)
        recordMotion(mWorld, mMover, at({5, 0, 0}), i * kStep);
    recordJump(mWorld, mMover, at({5, 0, 0}), 101 * kStep);
    EXPECT_TRUE(hasCutWithin(path(), 100 * kStep, 101 * kStep));
    EXPECT_TRUE(validatePath(path()).ok());
}

TEST_F(RecordedMotionTest, TheScaleOfTheRestPoseStays) {
    Transform large;
    large.scale = dvec3(3.0);
    mWorld.registry.add(mMover, LocalTransform{large});
    recordMotion(mWorld, mMover, at({1, 0, 0}), 0.0);
    EXPECT_NEAR(glm::length(worldFromEntity(mWorld, mMover, 0.0)[0]), 3.0, 1e-12);
}

TEST_F(RecordedMotionTest, RefusesTimesThatDoNotRiseAndPosesThatAreNoWhere) {
    recordMotion(mWorld, mMover, at({1, 0, 0}), 1.0);
    EXPECT_DEATH(recordMotion(mWorld, mMover, at({1, 0, 0}), 1.0), "recorded at 1 seconds after 1");
    EXPECT_DEATH(recordMotion(mWorld, mMover, at({kNaN, 0, 0}), 2.0), "not finite");
    EXPECT_DEATH(recordMotion(mWorld, mMover, at({0, 0, 0}), kNaN), "not finite");
}

} // namespace
} // namespace shutter::scene
