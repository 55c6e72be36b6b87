// SPDX-License-Identifier: MIT
#include "engine/scene/history.h"
#include "game/demos/gallery_aim.h"
#include "game/demos/gallery_balls.h"
#include "game/demos/gallery_targets.h"
#include "game/demos/stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace shutter::game {
namespace {

using math::dvec3;

class Gallery : public testing::Test {
  protected:
    ecs::Entity addTarget(const dvec3& rail, double speed) {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, SimulatedPose{});
        Target target;
        target.rail = rail;
        target.halfLength = 4.0;
        target.slowest = 3.0;
        target.fastest = 6.0;
        target.speed = speed;
        mWorld.registry.add(entity, target);
        return entity;
    }

    ecs::Entity addBall() {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, SimulatedPose{});
        mWorld.registry.add(entity, Ball{});
        scene::hide(mWorld, entity);
        return entity;
    }

    [[nodiscard]] const Target& target(ecs::Entity entity) const {
        return mWorld.registry.get<Target>(entity);
    }

    [[nodiscard]] const SimulatedPose& pose(ecs::Entity entity) const {
        return mWorld.registry.get<SimulatedPose>(entity);
    }

    void runTargets(double seconds) {
        for (int i = 0; i < std::lround(seconds * kDemoStepsPerSecond); ++i)
            stepTargets(mWorld.registry, mRandom);
    }

    scene::World mWorld;
    Random mRandom{5};
};

TEST_F(Gallery, TargetsCrossAndComeInAgainByAJump) {
    const ecs::Entity entity = addTarget({0, 1, -5}, 5.0);
    runTargets(0.5);
    EXPECT_NEAR(pose(entity).transform.translation.x, 2.5, 1e-9);
    EXPECT_FALSE(pose(entity).jumped);
    runTargets(0.4);
    EXPECT_TRUE(pose(entity).jumped);
    EXPECT_LT(pose(entity).transform.translation.x, 0.0);
    EXPECT_GE(target(entity).speed, 3.0);
    EXPECT_LE(target(entity).speed, 6.0);
}

TEST_F(Gallery, AHitIsWorthTheTargetsSpeedOnceAndKnocksItOver) {
    const ecs::Entity entity = addTarget({0, 1, -5}, -5.5);
    const dvec3 face(0.0, 1.5, -5.0);
    EXPECT_FALSE(hitTarget(mWorld.registry, face + dvec3(0, 0, 0.3), 0.1)) << "before it";
    EXPECT_FALSE(hitTarget(mWorld.registry, face + dvec3(0.5, 0, 0), 0.1)) << "beside it";
    const auto hit = hitTarget(mWorld.registry, face + dvec3(0.2, 0.1, 0.1), 0.1);
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->target, entity);
    EXPECT_EQ(pointsFor(*hit), 55);
    EXPECT_FALSE(hitTarget(mWorld.registry, face, 0.1)) << "it is down";
    runTargets(0.3);
    EXPECT_GT(target(entity).fall, 1.4);
    runTargets(3.0);
    EXPECT_EQ(target(entity).fall, 0.0) << "it has come in again";
}

TEST_F(Gallery, AFlyingBallCannotPassThroughAFaceBetweenTwoSteps) {
    // 24 m/s in a step against the depth in which a ball meets a face.
    EXPECT_LT(24.0 * kDemoStepSeconds, 2.0 * (0.025 + kBallRadius));
}

TEST_F(Gallery, BallsBounceLoseEnergyAndArePickedUp) {
    const ecs::Entity entity = addBall();
    throwBall(mWorld, {0, 1.5, 0}, {3, 2, -24}, 0.0);
    EXPECT_FALSE(scene::isHidden(mWorld, entity));
    EXPECT_TRUE(pose(entity).jumped);
    const auto energy = [&] {
        return measureEnergy(
            std::as_const(mWorld).registry.get<Ball>(entity), pose(entity).transform.translation.y
        );
    };
    const double first = energy();
    double most = first;
    const BallRoom room;
    for (int i = 0; i < kDemoStepsPerSecond * 4; ++i) {
        stepBalls(mWorld, room);
        most = std::max(most, energy());
        const dvec3 place = pose(entity).transform.translation;
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_GE(place[axis], room.low[axis]);
            ASSERT_LE(place[axis], room.high[axis]);
        }
    }
    EXPECT_LE(most, first + 0.5) << "beyond the rounding of one step";
    EXPECT_LT(energy(), 0.2 * first);
    for (int i = 0; i < kDemoStepsPerSecond * 2; ++i)
        stepBalls(mWorld, room);
    EXPECT_TRUE(scene::isHidden(mWorld, entity));
}

TEST_F(Gallery, WhereAllBallsFlyTheOldestIsThrownAgainAndWithoutOneNothingHappens) {
    throwBall(mWorld, {0, 1, 0}, {0, 0, -20}, 0.0);
    const ecs::Entity first = addBall();
    const ecs::Entity second = addBall();
    throwBall(mWorld, {0, 1, 0}, {0, 0, -20}, 0.0);
    stepBalls(mWorld, {});
    throwBall(mWorld, {0, 1, 0}, {0, 0, -20}, 0.1);
    stepBalls(mWorld, {});
    const auto age = [&](ecs::Entity entity) {
        return std::as_const(mWorld).registry.get<Ball>(entity).seconds;
    };
    EXPECT_GT(age(first), age(second));
    throwBall(mWorld, {0, 1, 0}, {0, 0, -20}, 0.2);
    EXPECT_EQ(age(first), 0.0);
}

TEST(Aim, RecoilKicksAndDecays) {
    Aim aim;
    kickBack(aim);
    double most = 0.0;
    for (int i = 0; i < kDemoStepsPerSecond; ++i) {
        stepAim(aim, {});
        most = std::max(most, aim.recoil);
    }
    EXPECT_GT(most, 0.02);
    EXPECT_LT(most, 0.2);
    EXPECT_NEAR(aim.recoil, 0.0, 1e-3);
    EXPECT_NEAR(aim.kick, 0.0, 1e-3);
}

TEST(Aim, StaysWithinItsBoundsAndTurnsToTheRight) {
    Aim aim;
    for (int i = 0; i < kDemoStepsPerSecond * 3; ++i)
        stepAim(aim, {.turn = 1.0, .drive = 1.0});
    EXPECT_EQ(aim.yaw, kMostYaw);
    EXPECT_EQ(aim.pitch, kMostPitch);
    const dvec3 ahead = aimPose(aim, {}).rotation * dvec3(0, 0, -1);
    EXPECT_GT(ahead.x, 0.5);
    EXPECT_GT(ahead.y, 0.3);
}

} // namespace
} // namespace shutter::game
