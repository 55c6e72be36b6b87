// SPDX-License-Identifier: MIT
#include "engine/scene/auto_focus.h"
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"
#include "game/play/loop/photo_mode.h"

#include <gtest/gtest.h>

namespace shutter::game {
namespace {

using app::Key;
using math::dvec3;

class PhotoFlight : public testing::Test {
  protected:
    PhotoFlight() {
        stage = world.registry.create();
        world.registry.add(stage, scene::Camera{});
        math::Transform placement;
        placement.translation = {1, 2, 3};
        placement.rotation = glm::angleAxis(0.4, glm::normalize(dvec3(0.3, 1.0, 0.2))); // it rolls
        world.registry.add(stage, scene::LocalTransform{placement});
        world.registry.add(stage, scene::LinearVelocity{{0, 0, -20}});
    }

    void fly(Key key, double seconds) {
        app::InputState input;
        input.down.set(static_cast<size_t>(key));
        camera.advance(world, input, seconds, 500.0);
    }

    [[nodiscard]] math::dmat4 at(ecs::Entity entity, double seconds) const {
        return worldFromEntity(world, entity, seconds);
    }

    void expectNear(const math::dmat4& a, const math::dmat4& b) const {
        for (int i = 0; i < 4; ++i)
            EXPECT_LT(glm::distance(a[i], b[i]), 1e-9) << "column " << i;
    }

    scene::World world;
    ecs::Entity stage;
    PhotoCamera camera;
    static constexpr double kNow = 0.5;
};

TEST_F(PhotoFlight, AnUnmovedPhotoCameraIsTheStagesCameraWithRoll) {
    camera.take(world, stage, kNow);
    camera.advance(world, {}, 0.1, 500.0);
    for (const double seconds : {kNow, kNow - 0.02})
        expectNear(at(camera.entity(), seconds), at(stage, seconds));
}

TEST_F(PhotoFlight, ItHasTheLensOfTheCameraItHangsOnAndWhatFocusesIt) {
    world.registry.add(stage, scene::CameraLens{.fStop = 2.0, .focusDistance = 7.0});
    world.registry.add(
        stage,
        scene::FocusMotion{
            {{0.0, 1.0, {}, false}, {1.0, 3.0, {}, false}}, scene::PathInterpolation::Linear}
    );
    camera.take(world, stage, kNow);
    for (const double seconds : {kNow - 0.1, kNow}) {
        const scene::CameraLens own = scene::lensAt(world, stage, seconds);
        const scene::CameraLens photo = scene::lensAt(world, camera.entity(), seconds);
        EXPECT_EQ(photo.fStop, 2.0);
        EXPECT_EQ(photo.focusDistance, own.focusDistance) << seconds;
    }
    camera.putBack(world);
    world.registry.remove<scene::FocusMotion>(stage);
    const ecs::Entity target = world.registry.create();
    world.registry.add(target, scene::LocalTransform{{.translation = {0, 0, -50}}});
    world.registry.add(stage, scene::AutoFocus{target});
    scene::advanceAutoFocus(world, kNow);
    const double focused = scene::lensAt(world, stage, kNow).focusDistance;
    EXPECT_GT(focused, 10.0);
    camera.take(world, stage, kNow);
    EXPECT_EQ(scene::lensAt(world, camera.entity(), kNow).focusDistance, focused);
}

TEST_F(PhotoFlight, ItHasTheViewersLensAtOnce) {
    world.registry.add(stage, scene::LensOverride{.fStop = 2.8, .focusDistance = 3.0});
    camera.take(world, stage, kNow);
    EXPECT_TRUE(scene::hasLens(world, camera.entity()));
    EXPECT_EQ(scene::lensAt(world, camera.entity(), kNow).focusDistance, 3.0);
}

TEST_F(PhotoFlight, ThePhotoCameraFliesAheadAndKeepsTheStageCamerasBlur) {
    camera.take(world, stage, kNow);
    const dvec3 ahead = -dvec3(at(stage, kNow)[2]);
    fly(Key::W, 0.5);
    const dvec3 moved = dvec3(at(camera.entity(), kNow)[3]) - dvec3(at(stage, kNow)[3]);
    EXPECT_GT(glm::dot(moved, ahead), 0.5);
    // It rides along: over an exposure it takes the way of the stage's camera.
    const dvec3 way = dvec3(at(camera.entity(), kNow)[3] - at(camera.entity(), kNow - 0.02)[3]);
    EXPECT_NEAR(way.z, -0.4, 1e-9);
    EXPECT_NEAR(glm::length(way), 0.4, 1e-9);
}

TEST_F(PhotoFlight, ScaleOfTheStagesCameraIsNotItsOwn) {
    const auto view = [&](ecs::Entity entity) { return worldFromRigid(world, entity, kNow); };
    const ecs::Entity above = world.registry.create();
    world.registry.add(stage, scene::Parent{above});
    for (const dvec3& scale : {dvec3(1, 3, 0.5), dvec3(-1, 1, 1), dvec3(10, 10, 10), dvec3(0)}) {
        world.registry.add(above, scene::LocalTransform{{{1, 0, 0}, {1, 0, 0, 0}, scale}});
        world.registry.get<scene::LocalTransform>(stage).transform.scale = {1, -2, 1};
        camera.take(world, stage, kNow);
        camera.advance(world, {}, 0.1, 500.0);
        expectNear(view(camera.entity()), view(stage));
        fly(Key::W, 0.5);
        const dvec3 way(view(camera.entity())[3] - view(stage)[3]);
        EXPECT_NEAR(glm::length(way), 2.0, 1e-9) << "4 m/s";
        EXPECT_NEAR(glm::dot(way, dvec3(view(stage)[2])), -2.0, 1e-9);
        camera.putBack(world);
    }
}

TEST_F(PhotoFlight, ThePhotoCameraIsMadeOnceAndLeavesNothingBehind) {
    camera.advance(world, {}, 0.1, 500.0); // not out: nothing to move
    const size_t before = world.registry.aliveCount();
    camera.take(world, stage, kNow);
    const ecs::Entity first = camera.entity();
    fly(Key::W, 0.5);
    camera.take(world, stage, kNow);
    EXPECT_EQ(camera.entity(), first);
    EXPECT_EQ(world.registry.aliveCount(), before + 1);
    camera.putBack(world);
    camera.putBack(world);
    EXPECT_FALSE(camera.isOut());
    EXPECT_EQ(world.registry.aliveCount(), before);
}

} // namespace
} // namespace shutter::game
