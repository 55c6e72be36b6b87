// SPDX-License-Identifier: MIT
// Shadows of maps against those of rays, at every scale, and shadows of what moves against the mean
// of many instants.
#include "engine/image/metrics.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace shutter {
namespace {

using extract::ShadowMode;
using math::dvec3;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class ShadowLaw : public test::GpuTest {};

const math::dquat kFlat = glm::angleAxis(-glm::radians(90.0), dvec3(1, 0, 0));

/// A floor seen from above, and a box over it.
SceneBuilder makeFloor(const test::Placement& box, double scale = 1.0) {
    SceneBuilder scene;
    scene.setPerspective(0.9, 0.05 * scale);
    const auto white = scene.addMaterial({});
    scene.moveCamera(
        {.position = dvec3(0, 4, 4) * scale,
         .rotation = glm::angleAxis(-glm::radians(45.0), dvec3(1, 0, 0))}
    );
    scene.add(test::makeQuad(8 * scale, 8 * scale, white), {.rotation = kFlat});
    test::Placement placed = box;
    placed.position *= scale;
    placed.velocity *= scale;
    scene.add(test::makeBox(dvec3(0.8 * scale), white), placed);
    return scene;
}

Shot makeShot(ShadowMode mode) {
    Shot shot;
    shot.width = 160;
    shot.height = 120;
    shot.exposureSeconds = 0.0;
    shot.ambient = math::vec3(0.1f);
    shot.shadows = {.mode = mode, .mapSize = 2048, .distance = 0.0, .instants = 32};
    return shot;
}

/// Brightness of the picture's darkest pixel.
double findDarkest(const image::Image& picture) {
    float darkest = 1.0e9f;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x)
            darkest = std::min(darkest, picture.at(x, y, 0));
    return darkest;
}

struct Agreement {
    double psnr = 0.0; ///< dB
    double gain = 0.0; ///< over a picture without shadows, dB
};

Agreement compareMapsWithRays(Stage& stage) {
    Shot shot = makeShot(ShadowMode::Sharp);
    const auto maps = stage.render(shot);
    shot.method = "truth";
    const auto rays = stage.render(shot);
    shot.shadows.mode = ShadowMode::None;
    const auto none = stage.render(shot);
    const double psnr = image::computePsnr(maps.color, rays.color);
    return {psnr, psnr - image::computePsnr(none.color, rays.color)};
}

TEST_F(ShadowLaw, MapsAndRaysAgreeFromACentimetreToAKilometre) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << device().info().name << " has no ray queries";
    for (const double scale : {0.01, 1.0, 1000.0}) {
        // It stands on the floor: a gap or a leak at its foot would count.
        SceneBuilder scene = makeFloor({.position = {0.3, 0.4, 0.2}}, scale);
        scene.addSun({-0.5, -1.0, -0.4}, 3.0f);
        Stage stage(device(), scene);
        const Agreement found = compareMapsWithRays(stage);
        EXPECT_GT(found.psnr, 45.0) << scale;
        EXPECT_GT(found.gain, 10.0) << scale;
    }
}

TEST_F(ShadowLaw, MapsThatNoImageOfTheDeviceHoldsAreRefused) {
    SceneBuilder scene = makeFloor({.position = {0.3, 0.6, 0.2}, .velocity = {1, 0, 0}});
    scene.addSun({-0.5, -1.0, -0.4}, 3.0f);
    gpu::DeviceOptions options;
    options.wanted = device().info().name;
    const auto small =
        test::openFaulty(options, "SHUTTER_FAULT_LIMITS", "maxImageDimension2D=4096");
    ASSERT_TRUE(small.ok()) << small.error().message;
    render::Renderer renderer(*small.value(), scene.world.assets);
    render::FrameRequest request;
    request.view.camera = scene.camera;
    request.view.width = 64;
    request.view.height = 48;
    request.view.exposure = scene::computeExposure({0.5}, 0.0);
    request.view.shadows = {.mode = ShadowMode::Blurred, .mapSize = 4096};
    const auto refused = renderer.renderFrame(scene.world, request, {});
    ASSERT_FALSE(refused.ok()) << "one map leaves no room for the mover's layers";
    EXPECT_NE(refused.error().message.find("--shadow-map-size"), std::string::npos);
    request.view.shadows.mapSize = 1024;
    EXPECT_TRUE(renderer.renderFrame(scene.world, request, {}).ok()) << "the next frame is fine";
}

TEST_F(ShadowLaw, ALitPlaneHasNoAcneAtAnyAngle) {
    // What is far below makes depths coarse.
    for (const auto& [height, other] :
         {std::pair{2.0, 100.0}, {0.5, 100.0}, {0.15, 100.0}, {0.5, -20000.0}}) {
        SceneBuilder scene = makeFloor({.position = {0, other, 0}});
        scene.addSun({-1.0, -height, -0.3}, 3.0f);
        Stage stage(device(), scene);
        Shot shot = makeShot(ShadowMode::None);
        shot.shadows.mapSize = other < 0.0 ? 2048 : 512;
        const auto lit = stage.render(shot);
        shot.shadows.mode = ShadowMode::Sharp;
        const auto shadowed = stage.render(shot);
        EXPECT_EQ(lit.color.pixels, shadowed.color.pixels) << height << ", " << other;
    }
}

TEST_F(ShadowLaw, ABallThatMovesHasNoAcne) {
    SceneBuilder scene;
    scene.setPerspective(0.9, 0.05);
    const auto white = scene.addMaterial({});
    scene.add(test::makeSphere(1.0, white), {.position = {0, 0, -3}, .velocity = {0.5, 0, 0}});
    scene.addSun({-0.3, -0.5, -1.0}, 3.0f);
    Stage stage(device(), scene);
    Shot shot = makeShot(ShadowMode::None);
    shot.exposureSeconds = 1.0;
    const auto lit = stage.render(shot);
    for (const ShadowMode mode : {ShadowMode::Sharp, ShadowMode::Blurred}) {
        shot.shadows.mode = mode;
        EXPECT_GT(image::computePsnr(lit.color, stage.render(shot).color), 50.0);
    }
}

TEST_F(ShadowLaw, ShadowsNearTheCameraAreInTheFinestMap) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << device().info().name << " has no ray queries";
    SceneBuilder scene = makeFloor({.position = {0.3, 0.6, 0.2}});
    const auto white = scene.addMaterial({});
    scene.add(test::makeBox(dvec3(5.0), white), {.position = {0, 0, -400}});
    scene.addSun({-0.5, -1.0, -0.4}, 3.0f);
    Stage stage(device(), scene);
    EXPECT_GT(compareMapsWithRays(stage).psnr, 45.0);
}

TEST_F(ShadowLaw, SpotsAndPointLightsCastThemToo) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << device().info().name << " has no ray queries";
    for (const auto& [kind, cone] :
         {std::pair{scene::LightKind::Spot, 0.9f},
          {scene::LightKind::Spot, 1.4f},
          {scene::LightKind::Point, 0.0f}}) {
        SceneBuilder scene = makeFloor({.position = {0.3, 0.6, 0.2}});
        const ecs::Entity light = scene.world.registry.create();
        scene.place(light, {.position = {1.0, 3.0, 0.5}, .rotation = kFlat});
        scene.world.registry.add(
            light, scene::Light{.kind = kind, .intensity = 30.0f, .outerConeAngle = cone}
        );
        Stage stage(device(), scene);
        Shot shot = makeShot(ShadowMode::Sharp);
        const auto maps = stage.render(shot);
        shot.method = "truth";
        const auto rays = stage.render(shot);
        shot.shadows.mode = ShadowMode::None;
        const auto none = stage.render(shot);
        const double psnr = image::computePsnr(maps.color, rays.color);
        EXPECT_GT(psnr, 40.0) << int(kind) << " " << cone;
        EXPECT_GT(psnr - image::computePsnr(none.color, rays.color), 10.0)
            << int(kind) << " " << cone;
    }
}

TEST_F(ShadowLaw, HolesOfAlphaMasksLetLightThroughAsRaysDo) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << device().info().name << " has no ray queries";
    SceneBuilder scene = makeFloor({.position = {0, 100, 0}});
    const auto holes = scene.addWaves(true);
    scene.add(test::makeQuad(2.0, 2.0, holes), {.position = {0.2, 1.0, 0}, .rotation = kFlat});
    scene.addSun({-0.2, -1.0, -0.1}, 3.0f);
    Stage stage(device(), scene);
    const Agreement found = compareMapsWithRays(stage);
    EXPECT_GT(found.psnr, 35.0);
    EXPECT_GT(found.gain, 10.0);
}

/// Decibels by which shadows over the exposure are nearer to the mean of 64 instants than shadows
/// of the raster instant, in a picture of the floor alone: the caster is above the camera.
double measureGain(gpu::Device& device, const SceneBuilder& scene, uint32_t instants = 32) {
    Stage stage(device, scene);
    Shot shot = makeShot(ShadowMode::Sharp);
    shot.shadows.instants = instants;
    shot.exposureSeconds = 1.0;
    const auto sharp = stage.render(shot);
    shot.shadows.mode = ShadowMode::Blurred;
    const auto blurred = stage.render(shot);
    shot.method = "accumulate";
    shot.instants = 64;
    const auto mean = stage.render(shot);
    EXPECT_LT(findDarkest(sharp.color), 0.2) << "no shadow is in the picture";
    const double before = image::computePsnr(sharp.color, mean.color);
    const double after = image::computePsnr(blurred.color, mean.color);
    ::testing::Test::RecordProperty("sharp_dB", std::to_string(before));
    ::testing::Test::RecordProperty("blurred_dB", std::to_string(after));
    return after - before;
}

TEST_F(ShadowLaw, AShadowOfWhatMovesIsTheMeanOverTheExposure) {
    SceneBuilder scene = makeFloor({.position = {2, 8, 1}, .velocity = {2.0, 0, 0.5}});
    scene.addSun({-0.25, -1.0, -0.1}, 3.0f);
    EXPECT_GT(measureGain(device(), scene), 25.0);
    EXPECT_GT(measureGain(device(), scene, 30), 25.0) << "the last run is not whole";
}

TEST_F(ShadowLaw, LargeMapsOfFourCascadesFitTheImageThatTheyAreDrawnInto) {
    SceneBuilder scene = makeFloor({.position = {0.3, 0.6, 0.2}, .velocity = {0.5, 0, 0}});
    const auto white = scene.addMaterial({});
    scene.add(test::makeBox(dvec3(5.0), white), {.position = {0, 0, -400}});
    scene.addSun({-0.5, -1.0, -0.4}, 3.0f);
    Stage stage(device(), scene);
    Shot shot = makeShot(ShadowMode::Blurred);
    shot.exposureSeconds = 1.0;
    const auto usual = stage.render(shot);
    shot.shadows.mapSize = 4096;
    EXPECT_GT(image::computePsnr(usual.color, stage.render(shot).color), 40.0);
}

TEST_F(ShadowLaw, AShadowOfWhatTurnsIsNearTheMean) {
    SceneBuilder scene =
        makeFloor({.position = {2, 8, 1}, .scale = {3, 0.3, 0.3}, .angularVelocity = {0, 0.7, 0}});
    scene.addSun({-0.25, -1.0, -0.1}, 3.0f);
    EXPECT_GT(measureGain(device(), scene), 25.0);
}

TEST_F(ShadowLaw, AShadowOfAWheelThatStandsUprightIsNearTheMean) {
    SceneBuilder scene = makeFloor({.position = {0, 100, 0}});
    const auto white = scene.addMaterial({});
    const dvec3 spoke(3.0, 0.3, 0.1);
    const auto wheel = scene.addMesh(
        {test::makeBox(spoke, white), test::makeBox(dvec3(spoke.y, spoke.x, spoke.z), white)}
    );
    scene.add(wheel, {.position = {3, 5, 1}, .angularVelocity = {0, 0, 0.8}});
    scene.addSun({-0.6, -1.0, -0.4}, 3.0f);
    EXPECT_GT(measureGain(device(), scene), 22.0);
}

TEST_F(ShadowLaw, ShadowsByALampAndASpotAreNearTheMean) {
    for (const scene::LightKind kind : {scene::LightKind::Point, scene::LightKind::Spot}) {
        SceneBuilder scene = makeFloor({.position = {1.0, 5.0, 0.5}, .velocity = {1.0, 0, 0.4}});
        const ecs::Entity light = scene.world.registry.create();
        scene.place(light, {.position = {1.5, 9.0, 0.5}, .rotation = kFlat});
        scene.world.registry.add(
            light, scene::Light{.kind = kind, .intensity = 300.0f, .outerConeAngle = 0.8f}
        );
        EXPECT_GT(measureGain(device(), scene), 20.0) << int(kind);
    }
}

TEST_F(ShadowLaw, WhatGoesBelowAReceiverShadesItNoLonger) {
    // Along the light: at the first of four instants far above the floor, then far below it, and in
    // the picture at none.
    const dvec3 way = glm::normalize(dvec3(-1.0, -0.3, 0.0));
    SceneBuilder scene = makeFloor({.position = 16.0 * way, .velocity = 80.0 * way});
    scene.addSun({-1.0, -0.3, 0.0}, 3.0f);
    Stage stage(device(), scene);
    Shot shot = makeShot(ShadowMode::Blurred);
    shot.exposureSeconds = 1.0;
    shot.shadows.instants = 4;
    const auto blurred = stage.render(shot);
    shot.method = "accumulate";
    shot.instants = 4;
    EXPECT_GT(image::computePsnr(blurred.color, stage.render(shot).color), 45.0);
}

TEST_F(ShadowLaw, WhatMovesHasItsOwnShadowOfTheRasterInstant) {
    SceneBuilder scene;
    scene.setPerspective(0.9, 0.05);
    const auto white = scene.addMaterial({});
    // A plate, and a bar that turns before it along with it.
    const auto mesh =
        scene.addMesh({test::makeQuad(9.0, 9.0, white), test::makeBox(dvec3(0.3, 4.0, 1.5), white)}
        );
    scene.add(mesh, {.position = {0, 0, -4}, .angularVelocity = {0, 0, 0.8}});
    scene.addSun({-0.7, -0.4, -1.0}, 3.0f);
    Stage stage(device(), scene);
    Shot shot = makeShot(ShadowMode::Sharp);
    shot.exposureSeconds = 1.0;
    const auto sharp = stage.render(shot);
    EXPECT_LT(findDarkest(sharp.color), 0.2) << "no shadow is in the picture";
    shot.shadows.mode = ShadowMode::Blurred;
    EXPECT_EQ(sharp.color.pixels, stage.render(shot).color.pixels);
}

TEST_F(ShadowLaw, AShadowOfWhatDeformsIsNearTheMean) {
    SceneBuilder scene = makeFloor({.position = {0, 100, 0}});
    const std::array joints{
        test::Placement{.position = {2.0, 5.5, 1.0}},
        test::Placement{.position = {0, 1.0, 0}, .angularVelocity = {0, 0, 0.9}}};
    test::addSkinned(scene, test::makeStrip(1.2, 2.4, 12, scene.addMaterial({})), joints);
    scene.addSun({-0.3, -1.0, -0.7}, 3.0f);
    EXPECT_GT(measureGain(device(), scene), 10.0);
}

TEST_F(ShadowLaw, WhatCastsNoShadowCostsNothing) {
    const auto countPasses = [](const render::FrameResult& result) {
        return std::count_if(
            result.statistics.passes.begin(),
            result.statistics.passes.end(),
            [](const auto& pass) { return pass.name.find("shadow") != std::string::npos; }
        );
    };
    SceneBuilder dark = makeFloor({.position = {0, 1, 0}});
    EXPECT_EQ(countPasses(test::renderOnce(device(), dark, makeShot(ShadowMode::Sharp))), 0);
    SceneBuilder scene = makeFloor({.position = {0, 1, 0}});
    scene.addSun({-0.25, -1.0, -0.1}, 3.0f);
    Stage stage(device(), scene);
    EXPECT_EQ(countPasses(stage.render(makeShot(ShadowMode::None))), 0);
    EXPECT_EQ(countPasses(stage.render(makeShot(ShadowMode::Sharp))), 2);
    EXPECT_EQ(countPasses(stage.render(makeShot(ShadowMode::Sharp))), 0) << "nothing has changed";
}

} // namespace
} // namespace shutter
