// SPDX-License-Identifier: MIT
// Where entities are at a time, and over an exposure whose time an artist scales.
#include "engine/math/transform.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/motion.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace shutter::scene {
namespace {

using math::dmat4;
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

/// An entity with -Z forward, below a parent that scales.
class WorldFromRigid : public WorldFromEntity {
  protected:
    void expectSame(ecs::Entity entity, const dmat4& expected) const {
        expectNear(worldFromRigid(mWorld, entity, 0.0), expected);
    }

    const math::Transform mPose{
        {1.0, 2.0, 3.0}, glm::angleAxis(0.7, glm::normalize(dvec3(1.0, 2.0, 3.0))), dvec3(1.0)};
};

TEST_F(WorldFromRigid, TheEntitysOwnScaleHasNoEffectAndItsParentsRotateItLikeTheirChildren) {
    const ecs::Entity parent = addEntity({{4.0, 0.0, 0.0}, glm::angleAxis(0.3, kUp), dvec3(2.0)});
    const ecs::Entity entity = addChild(parent, mPose);
    const dmat4 plain = worldFromRigid(mWorld, entity, 0.0);
    expectSame(entity, math::removeScale(worldFromEntity(mWorld, entity, 0.0)));
    for (const dvec3& scale :
         {dvec3(2, 3, 4), dvec3(-1, 1, 1), dvec3(1, 1, -1), dvec3(-1), dvec3(1, 0, 1), dvec3(0)}) {
        mWorld.registry.get<LocalTransform>(entity).transform.scale = scale;
        expectSame(entity, plain);
    }
    add(entity, LocalTransform{mPose});
    for (const dvec3& scale :
         {dvec3(1, 3, 0.5), dvec3(-1, 1, 1), dvec3(1, 1, -1), dvec3(1, 0, 2)}) {
        mWorld.registry.get<LocalTransform>(parent).transform.scale = scale;
        const dmat4 carried = worldFromEntity(mWorld, entity, 0.0);
        expectSame(entity, math::removeScale(carried));
        expectNear(
            dvec3(worldFromRigid(mWorld, entity, 0.0)[2]), glm::normalize(dvec3(carried[2]))
        );
    }
}

TEST_F(WorldFromRigid, ParentScaleIsIgnoredIfItLeavesNoDirection) {
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

TEST_F(WorldFromEntity, AStaticEntitysTransformIsLocalAtAnyTime) {
    const math::Transform transform{
        {1.0, 2.0, 3.0},
        glm::angleAxis(0.7, glm::normalize(dvec3(1.0, 2.0, 3.0))),
        {2.0, 0.0, -1.0}};
    for (const ecs::Entity entity : {addEntity(transform), addChild(ecs::kNullEntity, transform)})
        for (const double seconds : {-1.0, 0.0, 1e6})
            EXPECT_EQ(worldFromEntity(mWorld, entity, seconds), math::computeMatrix(transform));
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

TEST_F(WorldFromEntity, ASpinningMovingEntityTurnsAboutItsOwnMovingOriginAfterItsRestRotation) {
    // Rest: x to z (about -y). Then a quarter turn about the parent's x takes z to -y.
    const ecs::Entity entity =
        addEntity({{5.0, 0.0, 0.0}, glm::angleAxis(-kPi / 2.0, kUp), dvec3(1.0)});
    add(entity, LinearVelocity{{0.0, 3.0, 0.0}});
    add(entity, AngularVelocity{{kPi / 2.0, 0.0, 0.0}});
    expectNear(pointAt(entity, dvec3(0.0), 1.0), {5.0, 3.0, 0.0}); // the origin goes straight
    expectNear(pointAt(entity, kUnitX, 0.0), {5.0, 0.0, 1.0});
    expectNear(pointAt(entity, kUnitX, 1.0), {5.0, 2.0, 0.0});
    expectNear(pointAt(entity, kUnitX, 2.0), {5.0, 6.0, -1.0});
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
    const ecs::Entity bare = mWorld.registry.create(); // starts from the identity
    const ecs::Entity moved = addEntity({{100.0, 0.0, 0.0}});
    for (const ecs::Entity entity : {bare, moved}) {
        add(entity, Animated{{{0, 0}}});
        add(entity, LinearVelocity{{0.0, 0.0, 1.0}});
        mWorld.playback.loop = false;
        expectNear(pointAt(entity, dvec3(0.0), 1.0), {0.0, 4.0, 1.0});
        expectNear(pointAt(entity, dvec3(0.0), 3.0), {0.0, 8.0, 3.0}); // the clip holds
        mWorld.playback.loop = true;
        expectNear(pointAt(entity, dvec3(0.0), 3.0), {0.0, 4.0, 3.0});
    }
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

TEST_F(WorldFromEntityDeathTest, CyclesStaleHandlesAndTimesThatAreNoNumberAreRefused) {
    const ecs::Entity parent = addEntity();
    const ecs::Entity child = addChild(parent);
    EXPECT_DEATH((void)worldFromEntity(mWorld, child, kNan), "nan seconds");
    EXPECT_DEATH((void)worldFromEntity(mWorld, ecs::kNullEntity, 0.0), "null entity");
    for (const ecs::Entity ring : {child, parent}) {
        add(parent, Parent{ring});
        EXPECT_DEATH((void)worldFromEntity(mWorld, child, 0.0), "form a cycle");
    }
    mWorld.registry.destroy(parent);
    EXPECT_DEATH((void)worldFromEntity(mWorld, child, 0.0), "entity 0 .* is not alive");
    EXPECT_DEATH((void)worldFromEntity(mWorld, parent, 0.0), "entity 0 .* is not alive");
}

TEST_F(WorldFromEntity, MayMoveIsTrueOnlyForEntitiesThatCouldMove) {
    const ecs::Entity still = addEntity();
    const ecs::Entity stillChild = addChild(still);
    EXPECT_FALSE(mayMove(mWorld, stillChild));
    const ecs::Entity slider = addEntity();
    mWorld.registry.add(slider, LinearVelocity{});
    const ecs::Entity spinner = addEntity();
    mWorld.registry.add(spinner, AngularVelocity{});
    EXPECT_FALSE(mayMove(mWorld, slider));
    EXPECT_FALSE(mayMove(mWorld, spinner));
    mWorld.registry.get<LinearVelocity>(slider).metresPerSecond.y = kNan;
    mWorld.registry.get<AngularVelocity>(spinner).radiansPerSecond.z = 0.1;
    const ecs::Entity animated = addEntity();
    mWorld.registry.add(animated, Animated{});
    for (const ecs::Entity mover : {slider, spinner, animated}) {
        EXPECT_TRUE(mayMove(mWorld, mover));
        EXPECT_TRUE(mayMove(mWorld, addChild(addChild(mover)))) << "with its parents";
    }
}

TEST(ComputeExposure, ThePhaseIsWhereTheFrameTimeLiesAndABadExposureIsOneInstant) {
    const std::pair<ShutterPhase, double> phases[] = {
        {ShutterPhase::Start, 0.0}, {ShutterPhase::Centre, 0.5}, {ShutterPhase::End, 1.0}};
    for (const auto& [phase, share] : phases)
        for (const double exposure : {0.5, 0.0, -0.0, -1.0, kNan, kInfinity, -kInfinity}) {
            const double length = exposure == 0.5 ? exposure : 0.0;
            const ExposureInterval interval = computeExposure({exposure, phase}, 10.0);
            EXPECT_DOUBLE_EQ(interval.open, 10.0 - share * length);
            EXPECT_DOUBLE_EQ(interval.raster, 10.0);
            EXPECT_DOUBLE_EQ(interval.close, 10.0 + (1.0 - share) * length);
            EXPECT_EQ(interval.rasterTime, share);
            EXPECT_DOUBLE_EQ(interval.at(interval.rasterTime), interval.raster);
        }
}

TEST(ExposureInterval, TimesAreExactAtBothEndsAndWithoutExposure) {
    const ExposureInterval interval = computeExposure({1.0 / 48.0, ShutterPhase::End}, 7.0 / 24.0);
    EXPECT_EQ(interval.at(0.0), interval.open);
    EXPECT_EQ(interval.at(1.0), interval.close);
    EXPECT_NEAR(interval.at(0.5), 7.0 / 24.0 - 1.0 / 96.0, 1e-15);
    const ExposureInterval instant = computeExposure({0.0, ShutterPhase::Centre}, 0.1);
    for (const double s : {0.0, 0.1, 0.3, 0.7, 1.0})
        EXPECT_EQ(instant.at(s), 0.1);
}

class Artist : public testing::Test {
  protected:
    Artist() : mCamera(addMover({0.5, 0.1, -0.3}, {0.2, 0.9, 0.1})) {
        mWorld.registry.add(mCamera, Camera{});
        // A camera's scale has no meaning and must not leak into what rides with it.
        mWorld.registry.get<LocalTransform>(mCamera).transform.scale = {2, 3, 0.5};
        mShutter.exposureSeconds = 0.5;
        mShutter.phase = ShutterPhase::Centre;
        mShutter.cuts.enabled = false;
    }

    ecs::Entity addMover(const dvec3& velocity, const dvec3& angular) {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, LocalTransform{{{1, 2, -5}, {1, 0, 0, 0}, dvec3(1.0)}});
        mWorld.registry.add(entity, LinearVelocity{velocity});
        mWorld.registry.add(entity, AngularVelocity{angular});
        return entity;
    }

    ecs::Entity addStill() {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, LocalTransform{{{0, 1, -4}, {1, 0, 0, 0}, dvec3(1.0)}});
        return entity;
    }

    [[nodiscard]] ExposureMotion motion() const {
        return {mWorld, mCamera, computeExposure(mShutter, kRaster, 1.0 / 24.0)};
    }

    [[nodiscard]] dmat4 world(ecs::Entity entity, double seconds) const {
        return scene::worldFromEntity(mWorld, entity, seconds);
    }

    [[nodiscard]] dmat4 view(double seconds) const {
        return scene::worldFromRigid(mWorld, mCamera, seconds);
    }

    static constexpr double kRaster = 3.0;
    World mWorld;
    CameraShutter mShutter;
    ecs::Entity mCamera;
};

TEST_F(Artist, ScalesOfOneChangeNoBit) {
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 3, 0});
    mWorld.registry.add(mover, MotionBlur{});
    const ExposureMotion now = motion();
    for (const double s : {0.0, 0.123, 0.5, 0.77, 1.0}) {
        const double seconds = s == 0.5 ? kRaster : now.exposure().at(s);
        EXPECT_EQ(now.worldFromEntity(mover, s), world(mover, seconds));
        EXPECT_EQ(now.worldFromObject(mover, s), world(mover, seconds));
        EXPECT_EQ(now.worldFromCamera(s), view(seconds));
    }
}

TEST_F(Artist, TheCamerasTurningAndDisplacementScaleApart) {
    for (const auto& [turning, displacement] :
         {std::pair{0.0, 1.0}, {1.0, 0.0}, {0.5, 2.0}, {0.0, 0.0}}) {
        mShutter.cameraRotationScale = turning;
        mShutter.cameraTranslationScale = displacement;
        const ExposureMotion now = motion();
        for (const double s : {0.0, 0.3, 1.0}) {
            const double away = now.exposure().at(s) - kRaster;
            dmat4 expected = view(kRaster + turning * away);
            expected[3] = world(mCamera, kRaster + displacement * away)[3];
            expectNear(now.worldFromCamera(s), expected);
        }
        EXPECT_EQ(now.worldFromCamera(0.5), view(kRaster));
    }
}

TEST_F(Artist, ObjectsScaleWithoutTheCamera) {
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 3, 0});
    for (const double scale : {0.0, 0.5, 2.0}) {
        mShutter.objectScale = scale;
        const ExposureMotion now = motion();
        for (const double s : {0.0, 0.3, 1.0}) {
            const double away = now.exposure().at(s) - kRaster;
            expectNear(now.worldFromEntity(mover, s), world(mover, kRaster + scale * away));
            expectNear(now.worldFromObject(mover, s), world(mover, kRaster + scale * away));
            expectNear(now.worldFromCamera(s), view(now.exposure().at(s)));
        }
        EXPECT_EQ(now.mayMove(mover), scale != 0.0);
        EXPECT_EQ(now.mayObjectMove(mover), scale != 0.0);
    }
}

TEST_F(Artist, AnEntitysScaleIsOfItsWayAcrossTheView) {
    for (const ecs::Entity entity : {addMover({1, 0, 0}, {0, 3, 0}), addStill()})
        for (const double scale : {0.0, 0.25, 1.5, 2.0}) {
            mWorld.registry.add(entity, MotionBlur{.scale = scale});
            const ExposureMotion now = motion();
            EXPECT_TRUE(now.mayObjectMove(entity)) << "under a moving camera";
            for (const double s : {0.0, 0.3, 0.5, 1.0}) {
                const double away = now.exposure().at(s) - kRaster;
                const double seen = kRaster + scale * away;
                // The same in the view as it would be at the other time.
                expectNear(
                    glm::inverse(now.worldFromCamera(s)) * now.worldFromObject(entity, s),
                    glm::inverse(view(seen)) * world(entity, seen)
                );
            }
            EXPECT_EQ(now.worldFromObject(entity, 0.5), world(entity, kRaster));
        }
}

TEST_F(Artist, ScalesMultiply) {
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 3, 0});
    mWorld.registry.add(mover, MotionBlur{.scale = 0.5});
    mShutter.cameraRotationScale = 0.5;
    mShutter.cameraTranslationScale = 1.5;
    mShutter.objectScale = 0.8;
    const ExposureMotion now = motion();
    const auto camera = [&](double away) {
        dmat4 pose = view(kRaster + 0.5 * away);
        pose[3] = view(kRaster + 1.5 * away)[3];
        return pose;
    };
    for (const double s : {0.0, 0.4, 1.0}) {
        const double away = now.exposure().at(s) - kRaster;
        expectNear(
            glm::inverse(camera(away)) * now.worldFromObject(mover, s),
            glm::inverse(camera(0.5 * away)) * world(mover, kRaster + 0.8 * 0.5 * away)
        );
    }
}

TEST_F(Artist, AnExcludedEntityRidesWithTheCamera) {
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 3, 0});
    for (const ecs::Entity entity : {mover, addStill()}) {
        mWorld.registry.add(entity, MotionBlur{.scale = 2.0, .exclude = true});
        const ExposureMotion now = motion();
        EXPECT_TRUE(now.mayObjectMove(entity));
        EXPECT_FALSE(now.mayDeform(entity));
        for (const double s : {0.0, 0.3, 1.0})
            expectNear(
                glm::inverse(now.worldFromCamera(s)) * now.worldFromObject(entity, s),
                glm::inverse(view(kRaster)) * world(entity, kRaster)
            );
    }
    mWorld.registry.remove<LinearVelocity>(mCamera);
    mWorld.registry.remove<AngularVelocity>(mCamera);
    const ExposureMotion still = motion();
    EXPECT_FALSE(still.mayObjectMove(mover)) << "under a static camera";
    EXPECT_EQ(still.worldFromObject(mover, 0.0), world(mover, kRaster));
}

TEST_F(Artist, TheNearestUpwardsCounts) {
    const ecs::Entity parent = addMover({1, 0, 0}, {0, 0, 0});
    const ecs::Entity child = addStill();
    mWorld.registry.add(child, Parent{parent});
    mWorld.registry.add(parent, MotionBlur{.exclude = true});
    const auto ridesWithTheCamera = [&] {
        const ExposureMotion now = motion();
        const dmat4 open = glm::inverse(now.worldFromCamera(0.0)) * now.worldFromObject(child, 0.0);
        const dmat4 raster = glm::inverse(view(kRaster)) * world(child, kRaster);
        return glm::length(dvec3(open[3]) - dvec3(raster[3])) < 1e-9;
    };
    EXPECT_TRUE(ridesWithTheCamera());
    mWorld.registry.add(child, MotionBlur{});
    EXPECT_FALSE(ridesWithTheCamera()) << "its own setting: as ever";
}

TEST_F(Artist, LightsFollowTheObjectScaleAlone) {
    const ecs::Entity lamp = addMover({1, 0, 0}, {0, 0, 0});
    mWorld.registry.add(lamp, MotionBlur{.exclude = true});
    mShutter.objectScale = 0.5;
    const ExposureMotion now = motion();
    const double away = now.exposure().at(0.0) - kRaster;
    expectNear(now.worldFromEntity(lamp, 0.0), world(lamp, kRaster + 0.5 * away));
}

TEST_F(Artist, DeformationIsTakenAtTheScaledTime) {
    const ecs::Entity entity = addStill();
    WeightChannel channel;
    channel.targetCount = 1;
    channel.times = {0.0f, 10.0f};
    channel.values = {0.0f, 1.0f};
    mWorld.assets.clips.emplace_back().weightChannels = {channel};
    mWorld.playback.activeClips = {true};
    mWorld.registry.add(entity, MorphWeights{{0.0f}, {{0, 0}}});
    mWorld.registry.add(entity, MotionBlur{.scale = 0.5});
    mShutter.objectScale = 0.8;
    const ExposureMotion now = motion();
    EXPECT_TRUE(now.mayDeform(entity));
    const double away = now.exposure().at(0.0) - kRaster;
    EXPECT_NEAR(
        now.deformationAt(entity, 0.0).morphWeights.at(0), (kRaster + 0.4 * away) / 10.0, 1e-7
    );
    EXPECT_NEAR(now.deformationAt(entity, 0.5).morphWeights.at(0), kRaster / 10.0, 1e-7);
    mShutter.objectScale = 0.0;
    EXPECT_FALSE(motion().mayDeform(entity));
}

TEST_F(Artist, APartOfTheExposureShowsWhatTheWholeShowsThen) {
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 3, 0});
    const ecs::Entity held = addMover({2, 0, 0}, {0, 0, 0});
    teleport(mWorld, held, {}, kRaster - 0.01);
    mWorld.registry.add(mover, MotionBlur{.scale = 0.5});
    mShutter.objectScale = 0.8;
    mShutter.cameraRotationScale = 2.0;
    const ExposureMotion whole = motion();
    const ExposureInterval& exposure = whole.exposure();
    for (const auto& [from, to] : {std::pair{0.0, 0.25}, {0.25, 0.75}, {0.75, 1.0}}) {
        const ExposureMotion part(
            mWorld, mCamera, takePart(exposure, exposure.at(from), exposure.at(to))
        );
        for (const double s : {0.0, 0.3, 1.0}) {
            const double at = std::lerp(from, to, s);
            for (const ecs::Entity entity : {mover, held}) {
                expectNear(part.worldFromEntity(entity, s), whole.worldFromEntity(entity, at));
                expectNear(part.worldFromObject(entity, s), whole.worldFromObject(entity, at));
            }
            expectNear(part.worldFromCamera(s), whole.worldFromCamera(at));
        }
        EXPECT_FALSE(part.mayMove(held)) << "a frame's events are those of all its parts";
    }
}

TEST_F(Artist, AnEventThatAScaleReachesCounts) {
    const ecs::Entity mover = addMover({1, 0, 0}, {0, 0, 0});
    appear(mWorld, mover, kRaster - 0.4); // open is 0.25 before the raster instant
    EXPECT_TRUE(motion().mayMove(mover));
    mShutter.objectScale = 2.0;
    EXPECT_FALSE(motion().mayMove(mover));
    mShutter.objectScale = 1.0;
    mWorld.registry.add(mover, MotionBlur{.scale = 2.0});
    EXPECT_FALSE(motion().mayMove(mover));
}

} // namespace
} // namespace shutter::scene
