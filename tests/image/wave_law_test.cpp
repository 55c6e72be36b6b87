// SPDX-License-Identifier: MIT
// Meshes that wave (scene::VertexWaves), in whole pictures.
#include "engine/image/metrics.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <numbers>

namespace shutter {
namespace {

using math::dvec3;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class WaveLaw : public test::GpuTest {};

constexpr std::string_view kMethods[] = {
    "sharp", "gather", "hybrid", "resolved", "accumulate", "truth"};

SceneBuilder makeRoom() {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.addSun(glm::normalize(dvec3(-0.3, -0.6, -0.8)), 2.0f);
    scene.add(
        test::makeQuad(8, 6, scene.addTextured(scene.addWaveTexture())), {.position = {0, 0, -5}}
    );
    return scene;
}

scene::Primitive makeCloth(SceneBuilder& scene) {
    scene::Primitive cloth =
        test::makeStrip(1.0, 1.4, 24, scene.addTextured(scene.addWaveTexture(), true));
    cloth.influenceCount = 0;
    cloth.joints.clear();
    cloth.weights.clear();
    return cloth;
}

TEST_F(WaveLaw, VerticesThatWaveAsOneDrawTheRigidMoversPicture) {
    // So slow and long a wave that its middle is a straight way, but for 4e-6 of it. Shorter, and
    // the sines of single precision would jitter.
    constexpr double kHertz = 1e-2;
    const dvec3 velocity(1.2, 0.5, 0.2);
    const dvec3 place(-0.2, -0.7, -2.6);
    for (const std::string_view method : kMethods) {
        if (method == "truth" ? !device().hasRayQuery() : method == "hybrid" && !device().hasRays())
            continue;
        SceneBuilder rigid = makeRoom();
        rigid.add(makeCloth(rigid), {.position = place, .velocity = velocity});
        SceneBuilder waving = makeRoom();
        const ecs::Entity entity = waving.add(makeCloth(waving), {.position = place});
        scene::VertexWaves waves;
        waves.waves = {{velocity / (2.0 * std::numbers::pi * kHertz), dvec3(0.0), kHertz, 0.0}};
        waving.world.registry.add(entity, waves);
        Shot shot{.method = method, .seconds = 0.1, .exposureSeconds = 0.3};
        shot.ambient = math::vec3(0.2f);
        const auto expected = test::renderOnce(device(), rigid, shot);
        const auto result = test::renderOnce(device(), waving, shot);
        // What deforms is found by fits of its tiles' motion, which perspective bends.
        const double bound = method == "resolved" ? 48.0 : 50.0;
        EXPECT_GT(image::computePsnr(result.color, expected.color), bound) << method;
    }
}

/// A cloth that turns and waves in a wind of the world, held at its foot.
SceneBuilder makeWind() {
    SceneBuilder scene = makeRoom();
    const ecs::Entity entity = scene.add(
        makeCloth(scene), {.position = {0.1, -0.8, -2.4}, .angularVelocity = {0.0, 0.8, 0.0}}
    );
    scene::VertexWaves waves;
    waves.inWorld = true;
    waves.share = scene::WaveShare::Height;
    waves.freeAt = 1.4;
    waves.exponent = 1.5;
    waves.lean = {0.2, 0.0, 0.0};
    waves.waves = {
        {{0.5, -0.1, 0.2}, {0.8, 1.0, 0.0}, 1.1, 0.3},
        {{0.1, 0.0, 0.1}, {4.0, 2.0, 1.0}, 3.7, 0.0}};
    scene.world.registry.add(entity, waves);
    return scene;
}

TEST_F(WaveLaw, RaysAndRastersSeeOneWind) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "no ray queries";
    const SceneBuilder scene = makeWind();
    Stage stage(device(), scene);
    Shot shot{.method = "truth", .seconds = 0.1, .exposureSeconds = 0.4, .instants = 256};
    shot.ambient = math::vec3(0.2f);
    const auto truth = stage.render(shot);
    shot.method = "accumulate";
    EXPECT_GE(image::computePsnr(truth.color, stage.render(shot).color), 45.0);
    shot.method = "sharp";
    EXPECT_LT(image::computePsnr(truth.color, stage.render(shot).color), 30.0)
        << "nothing is blurred";
}

TEST_F(WaveLaw, ResolvedFollowsTheWindBetterThanAnyFilter) {
    const SceneBuilder scene = makeWind();
    Stage stage(device(), scene);
    Shot shot{.method = "accumulate", .seconds = 0.1, .exposureSeconds = 0.15, .instants = 256};
    shot.ambient = math::vec3(0.2f);
    const image::Image truth = stage.render(shot).color;
    const auto measure = [&](std::string_view method) {
        return image::computePsnr(
            stage
                .render(
                    {.method = method,
                     .seconds = 0.1,
                     .exposureSeconds = 0.15,
                     .ambient = math::vec3(0.2f)}
                )
                .color,
            truth
        );
    };
    const double resolved = measure("resolved");
    for (const std::string_view filter : {"sharp", "gather", "guertin2014", "jimenez2014"})
        EXPECT_GT(resolved, measure(filter) + 3.0) << filter;
}

} // namespace
} // namespace shutter
