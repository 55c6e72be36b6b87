// SPDX-License-Identifier: MIT
// What a ray meets: sides, blended and hidden things, and shapes as they are at the time.
#include "engine/scene/history.h"
#include "engine/scene/ray_cast.h"
#include "tests/kit/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shutter::scene {
namespace {

using test::SceneBuilder;

std::optional<double> measure(const SceneBuilder& scene, double seconds = 0.0) {
    return findMiddleDistance(scene.world, scene.camera, seconds);
}

TEST(RayCast, TheNearestSurfaceIsMetAndTheSkyIsNothing) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    EXPECT_FALSE(measure(scene));
    const AssetIndex grey = scene.addColor({0.5f, 0.5f, 0.5f});
    scene.add(test::makeQuad(4, 4, grey), {.position = {0, 0, -9}});
    const ecs::Entity box = scene.add(test::makeBox({1, 1, 1}, grey), {.position = {0.2, 0.1, -5}});
    EXPECT_NEAR(measure(scene).value(), 4.5, 1e-6);
    EXPECT_EQ(castRay(scene.world, {{0, 0, 0}, {0, 0, -1}}, 0.0).value().entity, box);
    EXPECT_NEAR(castRay(scene.world, {{0, 0, 0}, {0, 0, -1}, 4.6}, 0.0)->distance, 9.0, 1e-6)
        << "from inside, a box is not seen";
    hide(scene.world, box);
    EXPECT_NEAR(measure(scene).value(), 9.0, 1e-6);
    scene.moveCamera({.position = {0, 3, 0}});
    EXPECT_FALSE(measure(scene));
}

TEST(RayCast, BacksAreSeenOfTwoSidedMaterialsAndThingsBehindPanes) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const math::dquat turned = glm::angleAxis(std::acos(-1.0), math::dvec3(0, 1, 0));
    Material pane;
    pane.alphaMode = AlphaMode::Blend;
    scene.add(test::makeQuad(2, 2, scene.addMaterial(pane)), {.position = {0, 0, -1}});
    const AssetIndex one = scene.addColor({1, 1, 1});
    scene.add(test::makeQuad(2, 2, one), {.position = {0, 0, -2}, .rotation = turned});
    EXPECT_FALSE(measure(scene));
    Material both;
    both.doubleSided = true;
    scene.add(
        test::makeQuad(2, 2, scene.addMaterial(both)), {.position = {0, 0, -3}, .rotation = turned}
    );
    EXPECT_NEAR(measure(scene).value(), 3.0, 1e-6);
    // A mirror turns the winding, not the side.
    scene.add(test::makeQuad(2, 2, one), {.position = {0, 0, -2.5}, .scale = {-1, 1, 1}});
    EXPECT_NEAR(measure(scene).value(), 2.5, 1e-6);
}

TEST(RayCast, ThingsAreWhereTheyAreThen) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const AssetIndex grey = scene.addColor({0.5f, 0.5f, 0.5f});
    const ecs::Entity quad =
        scene.add(test::makeQuad(1, 1, grey), {.position = {0, 0, -2}, .velocity = {0, 0, -1}});
    EXPECT_NEAR(measure(scene, 3.0).value(), 5.0, 1e-6);
    VertexWaves waves;
    waves.lean = {0, 0, 0.25};
    waves.waves.push_back({.displacement = {0, 0, 0.5}, .hertz = 1.0});
    scene.world.registry.add(quad, waves);
    EXPECT_NEAR(measure(scene, 1.0).value(), 2.75, 1e-6);
    EXPECT_NEAR(measure(scene, 1.25).value(), 2.5, 1e-6);
    // Nowhere, and flat.
    const AssetIndex mesh = scene.world.registry.get<MeshInstance>(quad).mesh;
    scene.add(mesh, math::dmat4(0.0));
    scene.add(mesh, math::dmat4(std::nan("")));
    EXPECT_NEAR(measure(scene, 1.0).value(), 2.75, 1e-6);
}

} // namespace
} // namespace shutter::scene
