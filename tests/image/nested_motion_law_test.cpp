// SPDX-License-Identifier: MIT
// Movers on movers: motion vectors against where finer pictures of the first and the last instant
// have the same point.
#include "engine/scene/path.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage.h"
#include "tests/support/white_quads.h"

namespace shutter {
namespace {

using scene::ShutterPhase;
using test::SceneBuilder;
using test::Stage;

class NestedMotionLaw : public test::GpuTest {
  protected:
    static void expectMotion(const SceneBuilder& scene, double longerThanPx) {
        Stage stage(device(), scene);
        for (const auto phase : {ShutterPhase::Start, ShutterPhase::Centre, ShutterPhase::End})
            test::expectMotionOfMarker(
                stage, {.seconds = 0.3, .exposureSeconds = 0.2, .phase = phase}, longerThanPx
            );
    }

    static ecs::Entity addPivot(SceneBuilder& scene, const test::Placement& placement) {
        const ecs::Entity entity = scene.world.registry.create();
        scene.world.registry.add(
            entity, scene::LocalTransform{{placement.position, placement.rotation, dvec3(1.0)}}
        );
        scene.world.registry.add(entity, scene::LinearVelocity{placement.velocity});
        scene.world.registry.add(entity, scene::AngularVelocity{placement.angularVelocity});
        return entity;
    }

    using dvec3 = math::dvec3;
};

TEST_F(NestedMotionLaw, APlaceOnTheWheelOfADrivingCar) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const ecs::Entity car = addPivot(
        scene,
        {.position = {-0.6, 0, -4},
         .rotation = glm::angleAxis(0.2, dvec3(0, 1, 0)),
         .velocity = {2.0, 0, 0.5},
         .angularVelocity = {0, 0.4, 0}}
    );
    const ecs::Entity wheel =
        addPivot(scene, {.position = {0.4, -0.3, 0.3}, .angularVelocity = {0, 0, -4.0}});
    scene.world.registry.add(wheel, scene::Parent{car});
    const ecs::Entity place = test::addMarker(scene, 0.3, {.position = {0.35, 0.1, 0}});
    scene.world.registry.add(place, scene::Parent{wheel});
    expectMotion(scene, 3.0);
}

TEST_F(NestedMotionLaw, AStillPlaceSeenFromACarThatTurns) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const ecs::Entity car =
        addPivot(scene, {.velocity = {1.0, 0, -2.0}, .angularVelocity = {0, -0.5, 0}});
    scene.world.registry.add(scene.camera, scene::Parent{car});
    scene.moveCamera({.position = {0.2, 0.5, 0.1}, .angularVelocity = {0.1, 0, 0.3}});
    (void)test::addMarker(scene, 0.3, {.position = {0.6, 0.6, -4}});
    expectMotion(scene, 3.0);
}

TEST_F(NestedMotionLaw, APlaceOnTheCarThatCarriesTheCamera) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const ecs::Entity car =
        addPivot(scene, {.velocity = {30.0, 0, -20.0}, .angularVelocity = {0, 2.0, 0}});
    scene.world.registry.add(scene.camera, scene::Parent{car});
    const ecs::Entity wiper =
        addPivot(scene, {.position = {0, -0.5, -2}, .angularVelocity = {0, 0, 3.0}});
    scene.world.registry.add(wiper, scene::Parent{car});
    const ecs::Entity place = test::addMarker(scene, 0.2, {.position = {0.2, 0.6, 0}});
    scene.world.registry.add(place, scene::Parent{wiper});
    expectMotion(scene, 3.0);
}

TEST_F(NestedMotionLaw, APlaceOnAPathSeenFromAPath) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const auto makePath = [](const dvec3& far) {
        scene::PathMotion path;
        for (int i = 0; i < 4; ++i) {
            scene::PathKey key;
            key.seconds = 0.2 * i;
            key.position = far + dvec3(0.3 * i, i % 2 == 0 ? 0.0 : 0.2, 0.1 * i);
            path.keys.push_back(key);
        }
        return path;
    };
    scene::PathMotion seen = makePath({-0.4, 0, -4});
    scene::PathMotion from = makePath({-0.2, 0.1, 0.5});
    for (scene::PathKey& key : from.keys)
        key.lookAt = dvec3(0.1, 0, -4) + 0.2 * key.seconds;
    const ecs::Entity place = test::addMarker(scene, 0.4, {});
    scene.world.registry.add(place, seen);
    scene.world.registry.add(scene.camera, from);
    expectMotion(scene, 1.0);
}

} // namespace
} // namespace shutter
