// SPDX-License-Identifier: MIT
// Pictures of all directions: where they are seen, what they light, and that every method, raster
// and rays, sees the same ones.
#include "engine/environment/directions.h"
#include "engine/environment/environment.h"
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage.h"

#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class EnvironmentLaw : public test::GpuTest {};

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
    SceneBuilder scene;
    scene.setPerspective(1.0);
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

TEST_F(EnvironmentLaw, OneOfOneColourIsTheBackgroundAndTheAmbientLight) {
    const math::vec3 color(0.5f, 0.25f, 0.75f);
    const SceneBuilder plain = makeBoxes();
    SceneBuilder surrounded = makeBoxes();
    surrounded.world.assets.environment =
        makeEnvironment([&](const dvec3&) { return dvec3(color); });
    Stage before(device(), plain);
    Stage after(device(), surrounded);
    std::vector<std::string_view> methods = test::listBlurMethods(device());
    methods.push_back("accumulate");
    if (device().hasRayQuery())
        methods.push_back("truth");
    for (const std::string_view method : methods) {
        Shot shot{.method = method, .background = color, .ambient = color, .instants = 8};
        const auto expected = before.render(shot);
        // The two colours do not count beside an environment.
        shot.background = shot.ambient = math::vec3(9.0f);
        const auto seen = after.render(shot);
        EXPECT_GT(image::computePsnr(expected.color, seen.color), 55.0) << method;
    }
}

TEST_F(EnvironmentLaw, EachDirectionIsWhereTheCameraLooks) {
    SceneBuilder scene;
    scene.setPerspective(0.4);
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

TEST_F(EnvironmentLaw, AMirrorShowsWhatLiesBesideTheCamera) {
    SceneBuilder scene;
    scene.setPerspective(0.2);
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

TEST_F(EnvironmentLaw, RaysAndTheMeanOfInstantsSeeTheSame) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << device().info().name << " has no ray queries";
    SceneBuilder scene = makeBoxes();
    scene.world.assets.environment = makeEnvironment(smoothWaves);
    Stage stage(device(), scene);
    const auto rays = stage.render({.method = "truth", .instants = 256});
    const auto instants = stage.render({.method = "accumulate", .instants = 256});
    EXPECT_GT(image::computePsnr(rays.color, instants.color), 40.0);
}

TEST_F(EnvironmentLaw, RevealsFindItBehindWhatMoves) {
    if (!device().hasRays())
        GTEST_SKIP() << device().info().name << " traces no rays";
    // A box of one colour before bright stripes of the sky and dark ones.
    SceneBuilder scene;
    scene.setPerspective(1.0);
    scene.world.assets.environment = makeEnvironment([](const dvec3& d) {
        return dvec3(std::sin(40.0 * d.x) > 0.0 ? 0.9 : 0.05);
    });
    scene.add(
        test::makeBox({0.8, 0.8, 0.2}, scene.addColor({0.1f, 0.5f, 0.1f})),
        {.position = {0, 0, -3}, .velocity = {1.2, 0.0, 0.0}}
    );
    Stage stage(device(), scene);
    const auto truth =
        stage.render({.method = "accumulate", .width = 192, .height = 128, .instants = 256});
    const auto psnrOf = [&](std::string_view method) {
        const auto seen = stage.render({.method = method, .width = 192, .height = 128});
        return image::computePsnr(seen.color, truth.color);
    };
    EXPECT_GT(psnrOf("hybrid"), psnrOf("gather") + 1.0);
}

} // namespace
} // namespace shutter
