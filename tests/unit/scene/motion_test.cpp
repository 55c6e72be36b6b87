// SPDX-License-Identifier: MIT
#include "engine/math/transform.h"
#include "engine/scene/motion.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace shutter::scene {
namespace {

using math::dmat4;
using math::dquat;
using math::dvec3;
using math::dvec4;
using math::vec4;

constexpr double kPi = std::numbers::pi;
const dvec3 kUnitX(1.0, 0.0, 0.0);

class WorldFromEntity : public testing::Test {
  protected:
    ecs::Entity addEntity(const math::Transform& transform = {}) {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, LocalTransform{transform});
        return entity;
    }

    ecs::Entity addChild(ecs::Entity parent, const math::Transform& transform = {}) {
        const ecs::Entity entity = addEntity(transform);
        mWorld.registry.add(entity, Parent{parent});
        return entity;
    }

    template <class T> void add(ecs::Entity entity, T component) {
        mWorld.registry.add(entity, std::move(component));
    }

    [[nodiscard]] dvec3 pointAt(ecs::Entity entity, const dvec3& local, double seconds) const {
        return dvec3(worldFromEntity(mWorld, entity, seconds) * dvec4(local, 1.0));
    }

    World mWorld;
};

/// What looks along -Z, below a parent that scales.
class WorldFromRigid : public WorldFromEntity {
  protected:
    void expectSame(ecs::Entity entity, const dmat4& expected) const {
        const dmat4 found = worldFromRigid(mWorld, entity, 0.0);
        for (int column = 0; column < 4; ++column)
            expectNear(dvec3(found[column]), dvec3(expected[column]));
    }

    const math::Transform mPose{
        {1.0, 2.0, 3.0}, glm::angleAxis(0.7, glm::normalize(dvec3(1.0, 2.0, 3.0))), dvec3(1.0)};
};

TEST_F(WorldFromRigid, ItsOwnScaleHasNoEffect) {
    const ecs::Entity parent = addEntity({{4.0, 0.0, 0.0}, glm::angleAxis(0.3, kUp), dvec3(2.0)});
    const ecs::Entity entity = addChild(parent, mPose);
    const dmat4 plain = worldFromRigid(mWorld, entity, 0.0);
    expectSame(entity, math::removeScale(worldFromEntity(mWorld, entity, 0.0)));
    for (const dvec3& scale :
         {dvec3(2, 3, 4), dvec3(-1, 1, 1), dvec3(1, 1, -1), dvec3(-1), dvec3(1, 0, 1), dvec3(0)}) {
        mWorld.registry.get<LocalTransform>(entity).transform.scale = scale;
        expectSame(entity, plain);
    }
}

TEST_F(WorldFromRigid, ParentsTurnItAsWhatTheyCarryIsTurned) {
    const ecs::Entity parent = addEntity();
    const ecs::Entity entity = addChild(parent, mPose);
    auto& scale = mWorld.registry.get<LocalTransform>(parent).transform.scale;
    for (const dvec3& given :
         {dvec3(1, 3, 0.5), dvec3(-1, 1, 1), dvec3(1, 1, -1), dvec3(1, 0, 2)}) {
        scale = given;
        const dmat4 carried = worldFromEntity(mWorld, entity, 0.0);
        expectSame(entity, math::removeScale(carried));
        expectNear(
            dvec3(worldFromRigid(mWorld, entity, 0.0)[2]), glm::normalize(dvec3(carried[2]))
        );
    }
}

TEST_F(WorldFromRigid, WhereNoDirectionIsLeftItLooksAsItDoesWithoutScale) {
    const ecs::Entity parent = addEntity({{4.0, 0.0, 0.0}, glm::angleAxis(0.3, kUp), dvec3(1.0)});
    const ecs::Entity entity = addChild(parent, mPose);
    const ecs::Entity rider = addChild(entity);
    add(rider, LocalMatrix{glm::scale(dmat4(1.0), dvec3(3.0))});
    dmat4 expected = worldFromRigid(mWorld, entity, 0.0);
    for (const dvec3& scale : {dvec3(0.0), dvec3(1e-200), dvec3(0.0, 1.0, 0.0)}) {
        mWorld.registry.get<LocalTransform>(parent).transform.scale = scale;
        expected[3] = worldFromEntity(mWorld, entity, 0.0)[3];
        expectSame(entity, expected);
        expectSame(rider, expected);
    }
    add(parent, LocalMatrix{glm::scale(dmat4(1.0), dvec3(0.0))}); // of a file: no rotation is left
    expectSame(entity, math::computeMatrix({{}, mPose.rotation, dvec3(1.0)}));
}

TEST_F(WorldFromRigid, ALightWithoutAnAxisShinesAsItDoesWithoutScale) {
    const ecs::Entity parent =
        addEntity({{4.0, 0.0, 0.0}, glm::angleAxis(0.3, kUp), dvec3(1.0, -2.0, -3.0)});
    const ecs::Entity light = addChild(parent, mPose);
    EXPECT_EQ(worldFromLight(mWorld, light, 0.0), worldFromEntity(mWorld, light, 0.0));
    mWorld.registry.get<LocalTransform>(parent).transform.scale = dvec3(1.0);
    const dmat4 plain = worldFromEntity(mWorld, light, 0.0);
    mWorld.registry.get<LocalTransform>(light).transform.scale = {1.0, 1.0, 0.0};
    expectNear(dvec3(worldFromLight(mWorld, light, 0.0)[2]), dvec3(plain[2]));
}

TEST_F(WorldFromEntity, WithoutAnyTransformIsTheIdentity) {
    const ecs::Entity entity = mWorld.registry.create();
    EXPECT_EQ(worldFromEntity(mWorld, entity, 3.0), dmat4(1.0));
}

TEST_F(WorldFromEntity, OfAStillEntityIsItsLocalTransformAtAnyTime) {
    const math::Transform transform{
        {1.0, 2.0, 3.0},
        glm::angleAxis(0.7, glm::normalize(dvec3(1.0, 2.0, 3.0))),
        {2.0, 0.0, -1.0}};
    const ecs::Entity entity = addEntity(transform);
    for (const double seconds : {-1.0, 0.0, 1e6})
        EXPECT_EQ(worldFromEntity(mWorld, entity, seconds), math::computeMatrix(transform));
}

TEST_F(WorldFromEntity, OfAnEntityWithZeroVelocitiesIsBitForBitStill) {
    const ecs::Entity entity = addEntity({{1.0, 2.0, 3.0}, glm::angleAxis(0.7, kUnitX), {1, 2, 3}});
    add(entity, LinearVelocity{});
    add(entity, AngularVelocity{});
    EXPECT_EQ(worldFromEntity(mWorld, entity, 0.1), worldFromEntity(mWorld, entity, 77.7));
}

TEST_F(WorldFromEntity, AMatrixReplacesTheTransform) {
    dmat4 shear(1.0);
    shear[1][0] = 0.5;
    const ecs::Entity entity = addEntity({{9.0, 9.0, 9.0}, {1.0, 0.0, 0.0, 0.0}, dvec3(9.0)});
    add(entity, LocalMatrix{shear});
    EXPECT_EQ(worldFromEntity(mWorld, entity, 0.0), shear);
}

TEST_F(WorldFromEntity, VelocitiesMoveAMatrixAboutItsOwnOrigin) {
    dmat4 matrix(1.0);
    matrix[1][0] = 0.5; // (x, y) to (x + y / 2, y)
    matrix[3] = dvec4(10.0, 0.0, 0.0, 1.0);
    const ecs::Entity entity = mWorld.registry.create();
    add(entity, LocalMatrix{matrix});
    add(entity, LinearVelocity{{0.0, 0.0, 4.0}});
    add(entity, AngularVelocity{{0.0, 0.0, kPi / 2.0}});
    // (0, 2) sheared is (1, 2), turned (-2, 1); the origin is at (10, 0, 4).
    expectNear(pointAt(entity, {0.0, 2.0, 0.0}, 1.0), {8.0, 1.0, 4.0});
}

TEST_F(WorldFromEntity, LinearVelocityCountsFromTimeZeroInEitherDirection) {
    const ecs::Entity entity = addEntity({{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, dvec3(5.0)});
    add(entity, LinearVelocity{{2.0, -4.0, 0.0}});
    expectNear(pointAt(entity, dvec3(0.0), 0.0), {1.0, 0.0, 0.0});
    expectNear(pointAt(entity, dvec3(0.0), 0.5), {2.0, -2.0, 0.0}); // scale does not matter
    expectNear(pointAt(entity, dvec3(0.0), -0.5), {0.0, 2.0, 0.0});
}

TEST_F(WorldFromEntity, AngularVelocityTurnsAfterTheRestRotation) {
    // Rest: x to z (about -y). Then a quarter turn about the parent's x takes z to -y.
    const ecs::Entity entity =
        addEntity({dvec3(0.0), glm::angleAxis(-kPi / 2.0, dvec3(0.0, 1.0, 0.0)), dvec3(1.0)});
    add(entity, AngularVelocity{{kPi / 2.0, 0.0, 0.0}});
    expectNear(pointAt(entity, kUnitX, 0.0), {0.0, 0.0, 1.0});
    expectNear(pointAt(entity, kUnitX, 1.0), {0.0, -1.0, 0.0});
}

TEST_F(WorldFromEntity, ASpinningMovingEntityTurnsAboutItsOwnMovingOrigin) {
    const ecs::Entity entity = addEntity({{5.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, dvec3(1.0)});
    add(entity, LinearVelocity{{0.0, 3.0, 0.0}});
    add(entity, AngularVelocity{{0.0, 0.0, kPi}});
    expectNear(pointAt(entity, dvec3(0.0), 1.0), {5.0, 3.0, 0.0}); // the origin goes straight
    expectNear(pointAt(entity, kUnitX, 1.0), {4.0, 3.0, 0.0});
    expectNear(pointAt(entity, kUnitX, 0.5), {5.0, 2.5, 0.0});
}

TEST_F(WorldFromEntity, AChildMovesInItsParentsSpace) {
    const ecs::Entity parent =
        addEntity({{0.0, 0.0, 7.0}, glm::angleAxis(kPi / 2.0, kUnitZ), dvec3(2.0)});
    const ecs::Entity child = addChild(parent);
    add(child, LinearVelocity{{1.0, 0.0, 0.0}});
    // x of the parent is y of the world, at twice the speed.
    expectNear(pointAt(child, dvec3(0.0), 3.0), {0.0, 6.0, 7.0});
}

TEST_F(WorldFromEntity, AChildOfASpinningParentGoesRound) {
    const ecs::Entity parent = addEntity({{10.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, dvec3(1.0)});
    add(parent, AngularVelocity{{0.0, 0.0, kPi / 2.0}});
    add(parent, LinearVelocity{{1.0, 0.0, 0.0}});
    const ecs::Entity child = addChild(parent, {{2.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, dvec3(1.0)});
    expectNear(pointAt(child, dvec3(0.0), 0.0), {12.0, 0.0, 0.0});
    expectNear(pointAt(child, dvec3(0.0), 1.0), {11.0, 2.0, 0.0});
    expectNear(pointAt(child, dvec3(0.0), 2.0), {10.0, 0.0, 0.0});
}

TEST_F(WorldFromEntity, AClipGivesThePoseAndVelocitiesAreAddedToIt) {
    AnimationChannel channel;
    channel.times = {0.0f, 2.0f};
    channel.values = {vec4(0.0f), vec4(0.0f, 8.0f, 0.0f, 0.0f)};
    mWorld.assets.clips.push_back({"up", 2.0, {channel}});
    const ecs::Entity entity = addEntity({{100.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, dvec3(1.0)});
    add(entity, Animated{{{0, 0}}});
    add(entity, LinearVelocity{{0.0, 0.0, 1.0}});
    expectNear(pointAt(entity, dvec3(0.0), 1.0), {0.0, 4.0, 1.0});
    expectNear(pointAt(entity, dvec3(0.0), 3.0), {0.0, 8.0, 3.0}); // the clip holds
    mWorld.playback.loop = true;
    expectNear(pointAt(entity, dvec3(0.0), 3.0), {0.0, 4.0, 3.0});
}

TEST_F(WorldFromEntity, AnAnimatedEntityWithoutATransformStartsFromTheIdentity) {
    AnimationChannel channel;
    channel.times = {0.0f};
    channel.values = {vec4(1.0f, 2.0f, 3.0f, 0.0f)};
    mWorld.assets.clips.push_back({"pose", 0.0, {channel}});
    const ecs::Entity entity = mWorld.registry.create();
    add(entity, Animated{{{0, 0}}});
    expectNear(pointAt(entity, dvec3(0.0), 0.0), {1.0, 2.0, 3.0});
}

TEST_F(WorldFromEntity, ANullParentIsARoot) {
    const ecs::Entity entity = addChild(ecs::kNullEntity, {{1, 2, 3}, {1, 0, 0, 0}, dvec3(1.0)});
    expectNear(pointAt(entity, dvec3(0.0), 0.0), {1.0, 2.0, 3.0});
}

TEST_F(WorldFromEntity, TenThousandParentsAddUp) {
    ecs::Entity entity = addEntity();
    for (int i = 0; i < 10000; ++i) {
        entity = addChild(entity, {{0.5, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, dvec3(1.0)});
        add(entity, LinearVelocity{{0.0, 0.25, 0.0}});
    }
    expectNear(pointAt(entity, dvec3(0.0), 2.0), {5000.0, 5000.0, 0.0});
}

using WorldFromEntityDeathTest = WorldFromEntity;

TEST_F(WorldFromEntityDeathTest, ACycleOfParentsIsFoundNotFollowedForEver) {
    const ecs::Entity first = addEntity();
    const ecs::Entity second = addChild(first);
    add(first, Parent{second});
    EXPECT_DEATH((void)worldFromEntity(mWorld, second, 0.0), "form a cycle");
    add(first, Parent{first});
    EXPECT_DEATH((void)worldFromEntity(mWorld, first, 0.0), "form a cycle");
}

TEST_F(WorldFromEntityDeathTest, StaleHandlesAndTimesThatAreNoNumberAreRefused) {
    const ecs::Entity parent = addEntity();
    const ecs::Entity child = addChild(parent);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_DEATH((void)worldFromEntity(mWorld, child, nan), "nan seconds");
    EXPECT_DEATH((void)worldFromEntity(mWorld, ecs::kNullEntity, 0.0), "null entity");
    mWorld.registry.destroy(parent);
    EXPECT_DEATH((void)worldFromEntity(mWorld, child, 0.0), "entity 0 .* is not alive");
    EXPECT_DEATH((void)worldFromEntity(mWorld, parent, 0.0), "entity 0 .* is not alive");
}

void expectInterval(
    const ExposureInterval& interval, double open, double raster, double close, double share
) {
    EXPECT_DOUBLE_EQ(interval.open, open);
    EXPECT_DOUBLE_EQ(interval.raster, raster);
    EXPECT_DOUBLE_EQ(interval.close, close);
    EXPECT_EQ(interval.rasterTime, share);
    EXPECT_DOUBLE_EQ(interval.at(interval.rasterTime), interval.raster);
}

TEST_F(WorldFromEntity, OnlyWhatCouldMoveMayMove) {
    const ecs::Entity still = addEntity();
    const ecs::Entity stillChild = addChild(still);
    EXPECT_FALSE(mayMove(mWorld, stillChild));
    const ecs::Entity slider = addEntity();
    mWorld.registry.add(slider, LinearVelocity{});
    const ecs::Entity spinner = addEntity();
    mWorld.registry.add(spinner, AngularVelocity{});
    EXPECT_FALSE(mayMove(mWorld, slider));
    EXPECT_FALSE(mayMove(mWorld, spinner));
    mWorld.registry.get<LinearVelocity>(slider).metresPerSecond.y =
        std::numeric_limits<double>::quiet_NaN();
    mWorld.registry.get<AngularVelocity>(spinner).radiansPerSecond.z = 0.1;
    const ecs::Entity animated = addEntity();
    mWorld.registry.add(animated, Animated{});
    for (const ecs::Entity mover : {slider, spinner, animated}) {
        EXPECT_TRUE(mayMove(mWorld, mover));
        EXPECT_TRUE(mayMove(mWorld, addChild(addChild(mover)))) << "with its parents";
    }
}

TEST(ComputeExposure, ThePhaseSaysWhereTheFrameTimeLies) {
    expectInterval(computeExposure({0.5, ShutterPhase::Start}, 10.0), 10.0, 10.0, 10.5, 0.0);
    expectInterval(computeExposure({0.5, ShutterPhase::Centre}, 10.0), 9.75, 10.0, 10.25, 0.5);
    expectInterval(computeExposure({0.5, ShutterPhase::End}, 10.0), 9.5, 10.0, 10.0, 1.0);
}

TEST(ComputeExposure, EndIsTheDefaultPhase) {
    CameraShutter shutter;
    shutter.exposureSeconds = 1.0;
    expectInterval(computeExposure(shutter, 0.0), -1.0, 0.0, 0.0, 1.0);
}

TEST(ComputeExposure, ZeroNegativeAndBadExposuresAreOneInstant) {
    const double infinity = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double exposure : {0.0, -0.0, -1.0, nan, infinity, -infinity}) {
        expectInterval(computeExposure({exposure, ShutterPhase::Start}, 2.5), 2.5, 2.5, 2.5, 0.0);
        expectInterval(computeExposure({exposure, ShutterPhase::Centre}, 2.5), 2.5, 2.5, 2.5, 0.5);
        expectInterval(computeExposure({exposure, ShutterPhase::End}, 2.5), 2.5, 2.5, 2.5, 1.0);
    }
}

TEST(ExposureInterval, AtIsExactAtBothEndsAndWithoutExposure) {
    const ExposureInterval interval = computeExposure({1.0 / 48.0, ShutterPhase::End}, 7.0 / 24.0);
    EXPECT_EQ(interval.at(0.0), interval.open);
    EXPECT_EQ(interval.at(1.0), interval.close);
    EXPECT_NEAR(interval.at(0.5), 7.0 / 24.0 - 1.0 / 96.0, 1e-15);
    const ExposureInterval instant = computeExposure({0.0, ShutterPhase::Centre}, 0.1);
    for (const double s : {0.0, 0.1, 0.3, 0.7, 1.0})
        EXPECT_EQ(instant.at(s), 0.1);
}

} // namespace
} // namespace shutter::scene
