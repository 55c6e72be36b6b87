// SPDX-License-Identifier: MIT
// Shadows of maps against those of rays and of many instants; pictures of all directions.
#include "engine/environment/directions.h"
#include "engine/environment/environment.h"
#include "engine/image/metrics.h"
#include "tests/image/laws.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using shadows::ShadowMode;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class LightLaw : public test::RayTest {};

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
    for (size_t i = 0; i < picture.pixels.size(); i += picture.channels)
        darkest = std::min(darkest, picture.pixels[i]);
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

TEST_F(LightLaw, MapsAndRaysAgreeFromACentimetreToAKilometre) {
    for (const double scale : {0.01, 1.0, 1000.0}) {
        // It is on the floor: a gap or a leak at its foot would be an error.
        SceneBuilder scene = makeFloor({.position = {0.3, 0.4, 0.2}}, scale);
        scene.addSun({-0.5, -1.0, -0.4}, 3.0f);
        Stage stage(device(), scene);
        const Agreement found = compareMapsWithRays(stage);
        EXPECT_GT(found.psnr, 45.0) << scale;
        EXPECT_GT(found.gain, 10.0) << scale;
    }
}

TEST_F(LightLaw, MapsThatNoImageOfTheDeviceHoldsAreRefused) {
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
    shadows::Shadows shadows(*small.value(), renderer.scene());
    render::ShadingFeature* const shading[] = {&shadows};
    shadows.configure({.mode = ShadowMode::Blurred, .mapSize = 4096});
    const auto refused = renderer.renderFrame(scene.world, request, {.shading = shading});
    ASSERT_FALSE(refused.ok()) << "one map leaves no room for the mover's layers";
    EXPECT_NE(refused.error().message.find("--shadow-map-size"), std::string::npos);
    shadows.configure({.mode = ShadowMode::Blurred, .mapSize = 1024});
    EXPECT_TRUE(renderer.renderFrame(scene.world, request, {.shading = shading}).ok())
        << "the next frame is fine";
}

TEST_F(LightLaw, ALitPlaneHasNoAcneAtAnyAngle) {
    // A surface far below makes depths coarse.
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

TEST_F(LightLaw, ABallThatMovesHasNoAcne) {
    SceneBuilder scene = test::makeView(0.9, 0.05);
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

TEST_F(LightLaw, ShadowsNearTheCameraAreInTheFinestMap) {
    SceneBuilder scene = makeFloor({.position = {0.3, 0.6, 0.2}});
    const auto white = scene.addMaterial({});
    scene.add(test::makeBox(dvec3(5.0), white), {.position = {0, 0, -400}});
    scene.addSun({-0.5, -1.0, -0.4}, 3.0f);
    Stage stage(device(), scene);
    EXPECT_GT(compareMapsWithRays(stage).psnr, 45.0);
}

TEST_F(LightLaw, SpotAndPointLightsCastShadows) {
    for (const auto& [kind, cone] :
         {std::pair{scene::LightKind::Spot, 0.9f},
          {scene::LightKind::Spot, 1.4f},
          {scene::LightKind::Point, 0.0f}}) {
        SceneBuilder scene = makeFloor({.position = {0.3, 0.6, 0.2}});
        test::addLight(
            scene,
            {.kind = kind, .intensity = 30.0f, .outerConeAngle = cone},
            {.position = {1.0, 3.0, 0.5}, .rotation = kFlat}
        );
        Stage stage(device(), scene);
        const Agreement found = compareMapsWithRays(stage);
        EXPECT_GT(found.psnr, 40.0) << int(kind) << " " << cone;
        EXPECT_GT(found.gain, 10.0) << int(kind) << " " << cone;
    }
}

TEST_F(LightLaw, LightPassesHolesOfAlphaMasksAsRaysDo) {
    SceneBuilder scene = makeFloor({.position = {0, 100, 0}});
    const auto holes = scene.addWaves(true);
    scene.add(test::makeQuad(2.0, 2.0, holes), {.position = {0.2, 1.0, 0}, .rotation = kFlat});
    scene.addSun({-0.2, -1.0, -0.1}, 3.0f);
    Stage stage(device(), scene);
    const Agreement found = compareMapsWithRays(stage);
    EXPECT_GT(found.psnr, 35.0);
    EXPECT_GT(found.gain, 10.0);
}

/// A caster above the camera, and by how many decibels its shadow over the exposure is nearer to
/// the mean of 64 instants than that of the raster instant, in a picture of the floor alone.
struct MovingShadow {
    const char* name;
    SceneBuilder (*make)();
    double leastGain;
};

SceneBuilder makeMoverBelow(scene::LightKind kind) {
    SceneBuilder scene = makeFloor({.position = {1.0, 5.0, 0.5}, .velocity = {1.0, 0, 0.4}});
    test::addLight(
        scene,
        {.kind = kind, .intensity = 300.0f, .outerConeAngle = 0.8f},
        {.position = {1.5, 9.0, 0.5}, .rotation = kFlat}
    );
    return scene;
}

const MovingShadow kMovingShadows[] = {
    {"a mover",
     [] {
         SceneBuilder scene = makeFloor({.position = {2, 8, 1}, .velocity = {2.0, 0, 0.5}});
         scene.addSun({-0.25, -1.0, -0.1}, 3.0f);
         return scene;
     },
     25.0},
    {"a bar that turns",
     [] {
         SceneBuilder scene = makeFloor(
             {.position = {2, 8, 1}, .scale = {3, 0.3, 0.3}, .angularVelocity = {0, 0.7, 0}}
         );
         scene.addSun({-0.25, -1.0, -0.1}, 3.0f);
         return scene;
     },
     25.0},
    {"a wheel that stands upright",
     [] {
         SceneBuilder scene = makeFloor({.position = {0, 100, 0}});
         const auto white = scene.addMaterial({});
         const dvec3 spoke(3.0, 0.3, 0.1);
         const auto wheel = scene.addMesh(
             {test::makeBox(spoke, white), test::makeBox(dvec3(spoke.y, spoke.x, spoke.z), white)}
         );
         scene.add(wheel, {.position = {3, 5, 1}, .angularVelocity = {0, 0, 0.8}});
         scene.addSun({-0.6, -1.0, -0.4}, 3.0f);
         return scene;
     },
     22.0},
    {"a mover by a lamp", [] { return makeMoverBelow(scene::LightKind::Point); }, 20.0},
    {"a mover by a spot", [] { return makeMoverBelow(scene::LightKind::Spot); }, 20.0},
    {"a caster that deforms",
     [] {
         SceneBuilder scene = makeFloor({.position = {0, 100, 0}});
         const std::array joints{
             test::Placement{.position = {2.0, 5.5, 1.0}},
             test::Placement{.position = {0, 1.0, 0}, .angularVelocity = {0, 0, 0.9}}};
         test::addSkinned(scene, test::makeStrip(1.2, 2.4, 12, scene.addMaterial({})), joints);
         scene.addSun({-0.3, -1.0, -0.7}, 3.0f);
         return scene;
     },
     10.0}};

TEST_F(LightLaw, ShadowsOfMoversAreNearTheMeanOverTheExposure) {
    for (const MovingShadow& each : kMovingShadows) {
        SCOPED_TRACE(each.name);
        const SceneBuilder scene = each.make();
        Shot shot = makeShot(ShadowMode::Sharp);
        shot.exposureSeconds = 1.0;
        test::Comparison floor(device(), scene, shot, 64);
        const auto sharp = floor.render("sharp");
        EXPECT_LT(findDarkest(sharp.color), 0.2) << "no shadow is in the picture";
        shot.shadows.mode = ShadowMode::Blurred;
        for (const uint32_t instants : {32u, 30u}) { // the last run of the second is not whole
            if (instants == 30u && &each != kMovingShadows)
                continue;
            shot.shadows.instants = instants;
            EXPECT_GT(floor.psnr(shot), floor.psnr(sharp) + each.leastGain) << instants;
        }
    }
}

TEST_F(LightLaw, LargeMapsOfFourCascadesFitTheImageThatTheyAreDrawnInto) {
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

TEST_F(LightLaw, ACasterBelowAReceiverDoesNotShadeIt) {
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

TEST_F(LightLaw, MoversCastTheShadowOfTheRasterInstant) {
    SceneBuilder scene = test::makeView(0.9, 0.05);
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

TEST_F(LightLaw, EntitiesWithoutShadowsCostNothing) {
    const auto count = [](const render::FrameResult& frame) {
        return test::countPasses(frame, "shadow");
    };
    SceneBuilder dark = makeFloor({.position = {0, 1, 0}});
    EXPECT_EQ(count(test::renderOnce(device(), dark, makeShot(ShadowMode::Sharp))), 0u);
    SceneBuilder scene = makeFloor({.position = {0, 1, 0}});
    scene.addSun({-0.25, -1.0, -0.1}, 3.0f);
    test::Frames frames(device(), scene);
    EXPECT_EQ(count(frames.draw(makeShot(ShadowMode::None))), 0u);
    EXPECT_EQ(count(frames.draw(makeShot(ShadowMode::Sharp))), 2u);
    EXPECT_EQ(count(frames.draw(makeShot(ShadowMode::Sharp))), 0u) << "nothing has changed";
}

template <class Radiance> scene::Environment makeEnvironment(const Radiance& radiance) {
    image::Image picture(512, 256, 3);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const dvec3 color(
                radiance(environment::directionAt({(x + 0.5) / 512.0, (y + 0.5) / 256.0}))
            );
            for (int c = 0; c < 3; ++c)
                picture.at(x, y, uint32_t(c)) = float(color[c]);
        }
    auto made = environment::makeEnvironment(std::move(picture), {});
    EXPECT_TRUE(made);
    return std::move(made).value();
}

/// No two directions alike, nor is any dark.
dvec3 smoothWaves(const dvec3& d) {
    return dvec3(0.5) + 0.3 * dvec3(std::sin(5.0 * d.x), std::sin(4.0 * d.y), std::cos(6.0 * d.z));
}

/// Lit boxes, one of which moves, before whatever is around them.
SceneBuilder makeBoxes() {
    SceneBuilder scene = test::makeView(1.0);
    scene.add(
        test::makeBox({0.7, 0.7, 0.7}, scene.addMaterial({.metallicFactor = 0.0f})),
        {.position = {-0.9, 0.1, -3}, .velocity = {1.2, 0.2, 0.0}, .angularVelocity = {0.2, 1, 0}}
    );
    scene.add(
        test::makeBox({0.6, 0.6, 0.6}, scene.addMaterial({.roughnessFactor = 0.3f})),
        {.position = {0.9, -0.3, -3.5}}
    );
    scene.moveCamera({.angularVelocity = {0.03, 0.12, 0.0}});
    return scene;
}

TEST_F(LightLaw, AUniformEnvironmentEqualsBackgroundAndAmbientLight) {
    const math::vec3 color(0.5f, 0.25f, 0.75f);
    const SceneBuilder plain = makeBoxes();
    SceneBuilder surrounded = makeBoxes();
    surrounded.world.assets.environment =
        makeEnvironment([&](const dvec3&) { return dvec3(color); });
    Stage before(device(), plain);
    Stage after(device(), surrounded);
    // Rays that miss, and lookups of the sky.
    std::vector<std::string_view> methods =
        test::pickMethods(test::listBlurMethods(device()), {"hybrid", "resolved"});
    methods.insert(methods.end(), {"accumulate", "truth"});
    for (const std::string_view method : methods) {
        Shot shot{.method = method, .background = color, .ambient = color, .instants = 8};
        const auto expected = before.render(shot);
        // The two colours are ignored with an environment.
        shot.background = shot.ambient = math::vec3(9.0f);
        const auto seen = after.render(shot);
        EXPECT_GT(image::computePsnr(expected.color, seen.color), 55.0) << method;
    }
}

TEST_F(LightLaw, EachDirectionIsWhereTheCameraPoints) {
    SceneBuilder scene = test::makeView(0.4);
    scene.world.assets.environment = makeEnvironment(smoothWaves);
    Stage stage(device(), scene);
    for (int i = 0; i < 12; ++i) {
        const math::dquat turn = glm::angleAxis(glm::radians(31.0 * i), dvec3(0, 1, 0)) *
                                 glm::angleAxis(glm::radians(-80.0 + 15.0 * i), dvec3(1, 0, 0));
        scene.moveCamera({.rotation = turn});
        const auto seen = stage.render({.width = 65, .height = 65, .exposureSeconds = 0.0});
        const dvec3 expected = smoothWaves(turn * dvec3(0, 0, -1));
        for (uint32_t c = 0; c < 3; ++c)
            EXPECT_NEAR(seen.color.at(32, 32, c), expected[int(c)], 0.01) << i;
    }
}

TEST_F(LightLaw, AMirrorShowsWhatLiesBesideTheCamera) {
    SceneBuilder scene = test::makeView(0.2);
    scene.world.assets.environment = makeEnvironment(smoothWaves);
    scene::Material mirror;
    mirror.roughnessFactor = 0.0f;
    // It faces halfway between the camera and +X.
    scene.add(
        test::makeQuad(4, 4, scene.addMaterial(mirror)),
        {.position = {0, 0, -3}, .rotation = glm::angleAxis(glm::radians(45.0), dvec3(0, 1, 0))}
    );
    Stage stage(device(), scene);
    const auto seen = stage.render({.width = 33, .height = 33, .exposureSeconds = 0.0});
    const dvec3 expected = smoothWaves({1, 0, 0});
    for (uint32_t c = 0; c < 3; ++c)
        // Karis' fit of the split sum loses a twentieth.
        EXPECT_NEAR(seen.color.at(16, 16, c), 0.955 * expected[int(c)], 0.02);
}

TEST_F(LightLaw, RaysAndTheMeanOfInstantsSeeTheSame) {
    SceneBuilder scene = makeBoxes();
    scene.world.assets.environment = makeEnvironment(smoothWaves);
    Stage stage(device(), scene);
    const auto rays = stage.render({.method = "truth", .instants = 256});
    const auto instants = stage.render({.method = "accumulate", .instants = 256});
    EXPECT_GT(image::computePsnr(rays.color, instants.color), 40.0);
}

TEST_F(LightLaw, RevealsFindTheEnvironmentBehindMovers) {
    // A box of one colour before bright stripes of the sky and dark ones.
    SceneBuilder scene = test::makeView(1.0);
    scene.world.assets.environment = makeEnvironment([](const dvec3& d) {
        return dvec3(std::sin(40.0 * d.x) > 0.0 ? 0.9 : 0.05);
    });
    test::addBox(
        scene,
        {0.8, 0.8, 0.2},
        {0.1f, 0.5f, 0.1f},
        {.position = {0, 0, -3}, .velocity = {1.2, 0.0, 0.0}}
    );
    test::Comparison sky(device(), scene, {.width = 192, .height = 128}, 128);
    EXPECT_GT(sky.psnr("hybrid"), sky.psnr("gather") + 1.0);
}

} // namespace
} // namespace shutter
