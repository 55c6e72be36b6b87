// SPDX-License-Identifier: MIT
// History: events in a world, and motion that a simulation records.
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"
#include "engine/scene/path.h"
#include "engine/scene/recorded_motion.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace shutter::scene {
namespace {

using math::dmat4;
using math::dquat;
using math::dvec3;
using math::Transform;

/// Frames of 0.1 s at t = 1, exposed over their last half.
class History : public testing::Test {
  protected:
    History() : mCamera(addMover({0.5, 0, 0})) {
        mWorld.registry.add(mCamera, Camera{});
        mShutter.exposureSeconds = 0.05;
    }

    ecs::Entity addMover(const dvec3& velocity) {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, LocalTransform{});
        mWorld.registry.add(entity, LinearVelocity{velocity});
        return entity;
    }

    ecs::Entity addChild(ecs::Entity parent) {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, Parent{parent});
        return entity;
    }

    [[nodiscard]] ExposureMotion motion(double raster = 1.0) const {
        return {mWorld, mCamera, computeExposure(mShutter, raster, 0.1)};
    }

    /// Where it moves, its motion is unchanged; where it is held, it has its place in the raster.
    void expectHeld(ecs::Entity entity, bool held, double raster = 1.0) const {
        const ExposureMotion now = motion(raster);
        EXPECT_EQ(now.mayMove(entity), !held);
        for (const double s : {0.0, 0.3, 1.0}) {
            const double seconds = held ? raster : now.exposure().at(s);
            expectNear(
                dvec3(now.worldFromEntity(entity, s)[3]),
                dvec3(scene::worldFromEntity(mWorld, entity, seconds)[3])
            );
            EXPECT_EQ(now.worldFromObject(entity, s), now.worldFromEntity(entity, s));
        }
        EXPECT_EQ(
            now.worldFromEntity(entity, now.exposure().rasterTime),
            scene::worldFromEntity(mWorld, entity, raster)
        );
    }

    World mWorld;
    CameraShutter mShutter;
    ecs::Entity mCamera;
};

TEST_F(History, EntitiesThatAppearAreStaticInThatFrameOnly) {
    const ecs::Entity mover = addMover({1, 0, 0});
    const ecs::Entity child = addChild(mover);
    const ecs::Entity other = addMover({2, 0, 0});
    // In the exposure, at the frame's own time, and in the frame before the shutter opens.
    for (const double seconds : {0.97, 1.0, 0.95, 0.93}) {
        appear(mWorld, mover, seconds);
        expectHeld(mover, true);
        expectHeld(child, true);
        expectHeld(other, false);
        expectHeld(mCamera, false);
    }
    // At the previous frame, which showed it already; long ago; and in a time to come.
    for (const double seconds : {0.9, 0.5, -10.0, 1.01}) {
        appear(mWorld, mover, seconds);
        expectHeld(mover, false);
    }
}

TEST_F(History, EventsCountFromWhenAnExposureLongerThanTheFrameBeginsUntilTheShutterCloses) {
    const ecs::Entity mover = addMover({1, 0, 0});
    appear(mWorld, mover, 0.8);
    expectHeld(mover, false);
    mShutter.exposureSeconds = 0.3;
    expectHeld(mover, true);
    // What happened as the shutter opened is over.
    appear(mWorld, mover, motion().exposure().open);
    expectHeld(mover, false);
    mShutter.exposureSeconds = 0.05;
    mShutter.phase = ShutterPhase::Start; // open after the raster instant
    appear(mWorld, mover, 1.02);
    expectHeld(mover, true);
    appear(mWorld, mover, 1.06);
    expectHeld(mover, false);
}

TEST_F(History, ATeleportPutsItThereAndItsVelocitiesGoOn) {
    const ecs::Entity mover = addMover({1, 0, 0});
    mWorld.registry.add(mover, AngularVelocity{{0, 2, 0}});
    const ecs::Entity child = addChild(mover);
    const Transform there{{50, 60, 70}, glm::angleAxis(0.4, dvec3(1, 0, 0)), dvec3(1.0)};
    teleport(mWorld, mover, there, 0.98);
    const dmat4 wanted = math::computeMatrix(there);
    expectNear(scene::worldFromEntity(mWorld, mover, 0.98), wanted);
    expectNear(dvec3(scene::worldFromEntity(mWorld, mover, 1.98)[3]), {51, 60, 70});
    expectHeld(mover, true);
    expectHeld(child, true);
    expectHeld(mover, false, 1.1);
    const ecs::Entity entity = mWorld.registry.create();
    mWorld.registry.add(entity, LocalMatrix{dmat4(2.0)});
    teleport(mWorld, entity, there, 1.0);
    EXPECT_EQ(scene::worldFromEntity(mWorld, entity, 3.0), wanted) << "it replaces a matrix";
}

TEST_F(History, ACutHoldsTheWholeWorldAndATeleportOfTheCameraItselfAlone) {
    const ecs::Entity mover = addMover({1, 0, 0});
    cut(mWorld, mCamera, 0.96);
    EXPECT_TRUE(motion().isCut());
    expectHeld(mover, true);
    expectHeld(mCamera, true);
    EXPECT_EQ(motion().worldFromCamera(0.0), motion().worldFromCamera(1.0));
    EXPECT_FALSE(motion(1.1).isCut());
    expectHeld(mover, false, 1.1);
    cutTo(mWorld, mCamera, {{0, 0, 9}}, 1.15);
    EXPECT_TRUE(motion(1.2).isCut());
    expectNear(dvec3(scene::worldFromEntity(mWorld, mCamera, 1.15)[3]), {0, 0, 9});
    teleport(mWorld, mCamera, {}, 1.97);
    EXPECT_FALSE(motion(2.0).isCut());
    EXPECT_EQ(motion(2.0).worldFromCamera(0.0), motion(2.0).worldFromCamera(1.0));
    expectHeld(mover, false, 2.0);
}

TEST_F(History, EntitiesHaveNoPastBeforeTheWorldBegan) {
    const ecs::Entity mover = addMover({1, 0, 0});
    EXPECT_EQ(World().startSeconds, -kInfinity);
    mWorld.startSeconds = 0.95;
    EXPECT_TRUE(motion().isCut());
    expectHeld(mover, true);
    EXPECT_FALSE(motion(1.1).isCut());
    mWorld.startSeconds = 5.0;
    EXPECT_TRUE(motion().isCut()) << "not begun yet";
}

TEST_F(History, ACutOfAPathIsACutOfTheCameraAndATeleportOfAnyOther) {
    PathMotion path;
    for (const double seconds : {0.0, 0.9, 0.98, 2.0}) {
        PathKey made;
        made.seconds = seconds;
        made.position = {seconds, 0, seconds > 0.95 ? 30.0 : 0.0};
        path.keys.push_back(made);
    }
    path.keys[2].cut = true;
    const ecs::Entity mover = addMover(dvec3(1, 0, 0));
    mWorld.registry.add(mover, path);
    expectHeld(mover, true);
    EXPECT_FALSE(motion().isCut());
    expectHeld(mover, false, 1.2);
    mWorld.registry.remove<PathMotion>(mover);
    expectHeld(mover, false);
    // On the vehicle that carries the camera.
    const ecs::Entity vehicle = addMover(dvec3(0.0));
    mWorld.registry.add(mCamera, Parent{vehicle});
    mShutter.cuts.enabled = false;
    mWorld.registry.add(vehicle, path);
    EXPECT_TRUE(motion().isCut());
    EXPECT_FALSE(motion(1.2).isCut());
}

TEST_F(History, ACameraThatJumpsByAStepOfItsClipIsCut) {
    AnimationChannel channel;
    channel.path = AnimationPath::Translation;
    channel.interpolation = Interpolation::Step;
    channel.times = {0.0f, 0.97f};
    channel.values = {math::vec4(0.0f), math::vec4(3.0f, 0.0f, 0.0f, 0.0f)};
    mWorld.assets.clips.push_back({"", 0.0, {channel}});
    mWorld.playback.activeClips = {true};
    mWorld.registry.add(mCamera, Animated{{{0, 0}}});
    const ecs::Entity mover = addMover({1, 0, 0});
    EXPECT_TRUE(motion().isCut());
    expectHeld(mover, true);
    mShutter.cuts.enabled = false;
    EXPECT_FALSE(motion().isCut());
    mShutter.cuts.enabled = true;
    mShutter.cuts.metres = 3.5;
    EXPECT_FALSE(motion().isCut());
}

TEST_F(History, SkinnedMeshesAreHeldWithTheirJoints) {
    const ecs::Entity root = addMover({1, 0, 0});
    const ecs::Entity joint = addChild(root);
    const ecs::Entity mesh = addMover(dvec3(0.0));
    mWorld.assets.skins.push_back({"", {dmat4(1.0)}});
    mWorld.registry.add(mesh, Skinned{0, {joint}});
    EXPECT_TRUE(motion().mayObjectMove(mesh));
    EXPECT_TRUE(motion().mayDeform(mesh));
    teleport(mWorld, root, {}, 0.97);
    const ExposureMotion now = motion();
    EXPECT_FALSE(now.mayObjectMove(mesh));
    EXPECT_FALSE(now.mayDeform(mesh));
    EXPECT_EQ(now.worldFromObject(mesh, 0.0), now.worldFromObject(mesh, 1.0));
    EXPECT_EQ(
        now.deformationAt(mesh, 0.0).objectFromBind, now.deformationAt(mesh, 1.0).objectFromBind
    );
}

TEST_F(History, HiddenIsHiddenWithItsDescendantsFromItsTimeAndShowingStamps) {
    const ecs::Entity mover = addMover({1, 0, 0});
    const ecs::Entity child = addChild(mover);
    EXPECT_FALSE(isHidden(mWorld, child));
    hide(mWorld, mover);
    EXPECT_TRUE(isHidden(mWorld, mover));
    EXPECT_TRUE(isHidden(mWorld, child, -1e300));
    EXPECT_TRUE(isAlwaysHidden(mWorld, child));
    EXPECT_FALSE(mayComeOrGo(mWorld, child, 0.0));
    EXPECT_FALSE(isHidden(mWorld, mCamera));
    show(mWorld, mover, 0.98);
    EXPECT_FALSE(isHidden(mWorld, child));
    EXPECT_TRUE(mayComeOrGo(mWorld, child, 0.97));
    EXPECT_FALSE(mayComeOrGo(mWorld, child, 0.98));
    expectHeld(mover, true);
    expectHeld(mover, false, 1.1);
    show(mWorld, mover, 1.05);
    expectHeld(mover, false, 1.1); // it was in sight all the time
    hide(mWorld, mover, 1.5);
    EXPECT_FALSE(isHidden(mWorld, child, 1.4999));
    EXPECT_TRUE(isHidden(mWorld, child, 1.5));
    EXPECT_TRUE(isHidden(mWorld, child)) << "at some time";
    EXPECT_FALSE(isAlwaysHidden(mWorld, child));
    EXPECT_TRUE(mayComeOrGo(mWorld, child, 9.0));
}

TEST_F(History, DespawningTakesDescendantsAndWhatHangsOnThem) {
    const ecs::Entity parent = addMover({1, 0, 0});
    const ecs::Entity child = addChild(addChild(parent));
    const ecs::Entity mesh = addMover(dvec3(0.0));
    mWorld.registry.add(mesh, Skinned{0, {child}});
    const ecs::Entity camera = addChild(parent);
    mWorld.cameras = {mCamera, camera};
    const ecs::Entity other = addMover({1, 0, 0});
    despawn(mWorld, parent);
    for (const ecs::Entity gone : {parent, child, mesh, camera})
        EXPECT_FALSE(mWorld.registry.isAlive(gone));
    EXPECT_TRUE(mWorld.registry.isAlive(other));
    EXPECT_EQ(mWorld.cameras, std::vector<ecs::Entity>{mCamera});
}

TEST_F(History, AnEventAtAFramesOwnTimeCountsInThatFrameOnly) {
    // Whatever the quotient n / 24 is rounded to.
    mShutter.mode = ShutterMode::Angle;
    mShutter.angleDegrees = 360.0;
    for (int n = 1; n < 3000; ++n) {
        cut(mWorld, mCamera, n / 24.0);
        const auto isCutAt = [&](int frame) {
            const auto exposure = computeExposure(mShutter, frame / 24.0, 1.0 / 24.0);
            return ExposureMotion(mWorld, mCamera, exposure).isCut();
        };
        ASSERT_FALSE(isCutAt(n - 1)) << n;
        ASSERT_TRUE(isCutAt(n)) << n;
        ASSERT_FALSE(isCutAt(n + 1)) << n;
    }
}

constexpr double kStep = 1.0 / 120.0;

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

TEST_F(RecordedMotionTest, AnExposureSeesTheStepsAsTheyWereWithTheScaleOfTheRestPose) {
    mWorld.registry.add(mMover, LocalTransform{{.scale = dvec3(3.0)}});
    recordMotion(mWorld, mMover, at({0, 0, 0}), 0.0);
    recordMotion(mWorld, mMover, at({1, 0, 0}), kStep);
    recordMotion(mWorld, mMover, at({1, 2, 0}), 2 * kStep);
    const ExposureMotion motion = exposureAt(2 * kStep, 2 * kStep);
    ASSERT_TRUE(motion.mayMove(mMover));
    const auto seen = [&](double s) { return dvec3(motion.worldFromEntity(mMover, s)[3]); };
    expectNear(seen(0.25), {0.5, 0, 0}, 1e-12);
    expectNear(seen(0.5), {1, 0, 0}, 1e-12);
    expectNear(seen(0.75), {1, 1, 0}, 1e-12);
    expectNear(seen(1.0), {1, 2, 0}, 1e-12);
    EXPECT_NEAR(glm::length(worldFromEntity(mWorld, mMover, 0.0)[0]), 3.0, 1e-12);
    EXPECT_DEATH(recordMotion(mWorld, mMover, at({1, 0, 0}), 2 * kStep), "seconds after");
    EXPECT_DEATH(recordMotion(mWorld, mMover, at({kNan, 0, 0}), 2.0), "not finite");
    EXPECT_DEATH(recordMotion(mWorld, mMover, at({0, 0, 0}), kNan), "not finite");
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
    const dmat4 body = math::computeMatrix({dvec3(0.0), bodyTurn(between)});
    expectNear(
        worldFromEntity(mWorld, wheel, between), body * math::computeMatrix(wheelPose(between))
    );
}

TEST_F(RecordedMotionTest, RecordedMotionKeepsItsReachAndNoMore) {
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

TEST_F(RecordedMotionTest, AnEntityAtRestCostsOneKeyAndNoChangeAndLeavesFromTheStepBefore) {
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
    recordMotion(mWorld, mMover, at({11, 0, 0}), 102 * kStep);
    EXPECT_EQ(placeAt(100.5 * kStep).x, 10.0);
    EXPECT_NEAR(placeAt(101.5 * kStep).x, 10.5, 1e-9);
    EXPECT_TRUE(validatePath(path()).ok());
}

TEST_F(RecordedMotionTest, AJumpIsNoMotionEvenOfARestedThingOntoItsPlace) {
    recordMotion(mWorld, mMover, at({0, 0, 0}), 0.0);
    recordMotion(mWorld, mMover, at({1, 0, 0}), kStep);
    recordJump(mWorld, mMover, at({50, 0, 0}), 2 * kStep);
    EXPECT_EQ(placeAt(1.9 * kStep).x, 1.0);
    EXPECT_EQ(placeAt(2.0 * kStep).x, 50.0);
    EXPECT_FALSE(exposureAt(2 * kStep, kStep).mayMove(mMover));
    recordMotion(mWorld, mMover, at({51, 0, 0}), 3 * kStep);
    EXPECT_TRUE(exposureAt(3 * kStep, kStep).mayMove(mMover));
    EXPECT_FALSE(exposureAt(3 * kStep, 2 * kStep).mayMove(mMover));
    for (int i = 4; i <= 100; ++i)
        recordMotion(mWorld, mMover, at({5, 0, 0}), i * kStep);
    recordJump(mWorld, mMover, at({5, 0, 0}), 101 * kStep);
    EXPECT_TRUE(hasCutWithin(path(), 100 * kStep, 101 * kStep));
    EXPECT_TRUE(validatePath(path()).ok());
}

} // namespace
} // namespace shutter::scene
