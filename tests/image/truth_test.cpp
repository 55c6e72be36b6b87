// SPDX-License-Identifier: MIT
// The truths: the mean of many instants and distributed rays, each against closed forms, the error
// estimate of rays, and agreement of both for any motion.
#include "engine/image/metrics.h"
#include "tests/image/laws.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

namespace shutter {
namespace {

using accumulate::PixelModel;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class AccumulateLaw : public test::GpuTest {};

SceneBuilder makeTumbling() {
    SceneBuilder scene = test::makeWavyRoom(5.0, 6.0, 5.0);
    test::addBox(
        scene,
        {0.8, 0.8, 0.8},
        {0.9f, 0.2f, 0.1f},
        {.position = {0.1, 0, -2.5},
         .velocity = {0.6, 0.2, 0.3},
         .angularVelocity = {0.3, 2.0, 1.0}}
    );
    return scene;
}

TEST_F(AccumulateLaw, MoreInstantsComeNearerToTheMean) {
    const SceneBuilder scene = makeTumbling();
    Stage stage(device(), scene);
    const auto accumulated = [&](uint32_t instants) {
        return stage
            .render({.method = "accumulate", .width = 64, .height = 48, .instants = instants})
            .color;
    };
    const auto truth = accumulated(256);
    const double with64 = image::computePsnr(accumulated(64), truth);
    const double with16 = image::computePsnr(accumulated(16), truth);
    EXPECT_GT(with64, with16);
    EXPECT_GT(with16, 25.0) << "16 instants are already near";
}

TEST_F(AccumulateLaw, OneInstantAndAStillFrameByItsOwnInstantsAreTheSharpPicture) {
    const SceneBuilder moving = makeTumbling();
    const SceneBuilder still = test::makeWavyRoom();
    for (const auto& [scene, shot] :
         {std::pair<const SceneBuilder&, Shot>{moving, {.method = "accumulate", .instants = 1}},
          {still, {.method = "accumulate", .instants = 1024, .maxStepPx = 1.0}}}) {
        Stage stage(device(), scene);
        EXPECT_TRUE(test::sameBits(stage.render({}).color, stage.render(shot).color));
    }
}

/// One metre is one pixel.
uint64_t countInstants(gpu::Device& device, const test::Placement& placement) {
    SceneBuilder scene = test::makePixelView(64);
    test::addCard(scene, {40, 6}, {1, 1, 1}, placement);
    const auto result = test::renderOnce(
        device, scene, {.method = "accumulate", .instants = 1024, .maxStepPx = 1.0}
    );
    return result.statistics.counters.at("instants");
}

TEST_F(AccumulateLaw, InstantsFollowTheLongestWayThoughItEndsWhereItBegan) {
    const math::dvec3 place(0, 0, -10);
    EXPECT_EQ(countInstants(device(), {.position = place}), 1u);
    EXPECT_EQ(countInstants(device(), {.position = place, .velocity = {11.5, 0, 0}}), 12u);
    const double turn = 2.0 * 3.14159265358979;
    const uint64_t turning =
        countInstants(device(), {.position = place, .angularVelocity = {0, 0, turn}});
    // Corners go 127 px; chords of the parts are up to a tenth shorter, pixels' centres lie within.
    EXPECT_GT(turning, 105u);
    EXPECT_LE(turning, 128u);
}

class TruthLaw : public test::RayTest {};

/// Lit and textured; only a box tumbles, if anything moves.
SceneBuilder makeScene(bool moves) {
    SceneBuilder scene = test::makeWavyRoom(5.0, 6.0, 5.0);
    scene.addSun({-0.3, -1.0, -0.8}, 2.0f);
    test::Placement placement{.position = {0.1, 0, -2.5}};
    if (moves) {
        placement.velocity = {0.6, 0.2, 0.3};
        placement.angularVelocity = {0.3, 2.0, 1.0};
    }
    scene.add(test::makeBox({0.8, 0.8, 0.8}, scene.addMaterial({})), placement);
    return scene;
}

/// Channels that differ by more than half floats round, 2^-11 of a value.
size_t countDifferent(const image::Image& sharp, const image::Image& rays) {
    size_t different = 0;
    for (size_t i = 0; i < sharp.pixels.size(); ++i)
        different += i % 4 < 3 && std::abs(sharp.pixels[i] - rays.pixels[i]) > 2e-3f;
    return different;
}

TEST_F(TruthLaw, AStillSceneIsTheSharpPicture) {
    const SceneBuilder scene = makeScene(false);
    Stage stage(device(), scene);
    const auto sharp = stage.render({.ambient = math::vec3(0.3f)});
    const auto rays = stage.render({.method = "truth", .ambient = math::vec3(0.3f), .instants = 4});
    EXPECT_EQ(rays.statistics.measures.at("standard error"), 0.0);
    // A silhouette that runs through a pixel's centre may fall to either side.
    EXPECT_LE(countDifferent(sharp.color, rays.color), 12u);
    EXPECT_GT(test::findBrightest(rays.color), 0.3);
}

TEST_F(TruthLaw, RaysSeeWhatRasterSeesThroughEveryCamera) {
    const auto scaleParent = [](SceneBuilder& scene, const math::dvec3& scale) {
        test::addParent(scene, scene.camera, {.scale = scale});
    };
    const auto magnify = [](SceneBuilder& scene, double x, double y) {
        scene.setPixelView(4);
        scene.cameraSettings().xMag = x;
        scene.cameraSettings().yMag = y;
    };
    const std::pair<const char*, std::function<void(SceneBuilder&)>> cameras[] = {
        {"sheared",
         [&](SceneBuilder& scene) {
             scene.moveCamera({.rotation = glm::angleAxis(0.4, math::dvec3(0, 0, 1))});
             scaleParent(scene, {1, 3, 1});
         }},
        {"mirrored",
         [&](SceneBuilder& scene) {
             scaleParent(scene, {-1, 1, 1});
         }},
        {"upside down",
         [&](SceneBuilder& scene) {
             scaleParent(scene, {2, -1, 1});
         }},
        {"a wide frame", [](SceneBuilder& scene) { scene.cameraSettings().aspectRatio = 2.5; }},
        {"a wide orthographic frame", [&](SceneBuilder& scene) { magnify(scene, 4.0, 2.0); }},
        {"a mirroring frame", [&](SceneBuilder& scene) { magnify(scene, -4.0, 2.0); }},
        {"a frame that mirrors twice", [&](SceneBuilder& scene) { magnify(scene, -1.0, -2.0); }}};
    for (const auto& [name, change] : cameras) {
        SceneBuilder scene = makeScene(false);
        change(scene);
        Stage stage(device(), scene);
        const auto sharp = stage.render({.ambient = math::vec3(0.3f)});
        const auto rays =
            stage.render({.method = "truth", .ambient = math::vec3(0.3f), .instants = 2});
        EXPECT_LE(countDifferent(sharp.color, rays.color), 12u) << name;
        EXPECT_GT(test::findBrightest(sharp.color), 0.3) << name;
    }
}

TEST_F(TruthLaw, TheBoxPixelIsTheAreaThatAStillQuadCovers) {
    // Silhouettes at 38.3 and 57.6: the pixels they cross are covered by 0.7 and 0.6.
    SceneBuilder scene = test::makePixelView(8);
    test::addCard(scene, {19.3, 20}, {1, 1, 1}, {.position = {-0.05, 0, -10}});
    Stage stage(device(), scene);
    // Hammersley's first 256 radical inverses of base 2 are the multiples of 1/256: the count to
    // one side of an edge is right to one. Rays meet it to one of the 128 strata of each set.
    for (const auto& [method, whole, part] :
         {std::tuple{"accumulate", 1.0 / 256.0, 1.0 / 256.0}, {"truth", 1e-6, 1.0 / 128.0}}) {
        const auto result =
            stage.render({.method = method, .height = 8, .instants = 256, .pixel = PixelModel::Box}
            );
        EXPECT_NEAR(result.color.at(37, 4, 0), 0.0, whole) << method;
        EXPECT_NEAR(result.color.at(38, 4, 0), 0.7, part) << method;
        EXPECT_NEAR(result.color.at(39, 4, 0), 1.0, whole) << method;
        EXPECT_NEAR(result.color.at(57, 4, 0), 0.6, part) << method;
        EXPECT_NEAR(result.color.at(58, 4, 0), 0.0, whole) << method;
    }
}

TEST_F(TruthLaw, AnyNumberOfRaysHasTheTrapezoidForItsMean) {
    // Also counts that are no power of two, and one: over 64 rows the errors average out.
    SceneBuilder scene = test::makePixelView(64);
    test::addCard(scene, {16, 100}, {1, 1, 1}, {.position = {0, 0, -10}, .velocity = {32, 0, 0}});
    Stage stage(device(), scene);
    for (const uint32_t rays : {1u, 3u, 5u}) {
        const auto result = stage.render({.method = "truth", .instants = rays, .seed = rays});
        for (const uint32_t x : {32u, 40u, 47u, 55u}) {
            double mean = 0.0;
            for (uint32_t y = 0; y < 64; ++y)
                mean += result.color.at(x, y, 0) / 64.0;
            const double at = x + 0.5 - 48.0;
            const double covered = std::clamp((at + 8.0) / 32.0 + 0.5, 0.0, 1.0) -
                                   std::clamp((at - 8.0) / 32.0 + 0.5, 0.0, 1.0);
            // Independent rays would have a standard deviation of at most 0.5 / 8.
            EXPECT_NEAR(mean, covered, 4.0 * 0.5 / 8.0 / std::sqrt(double(rays)))
                << rays << " rays at " << x;
        }
    }
}

double computeRms(const image::Image& a, const image::Image& b) {
    double sum = 0.0;
    for (uint32_t y = 0; y < a.height; ++y)
        for (uint32_t x = 0; x < a.width; ++x)
            for (uint32_t c = 0; c < 3; ++c)
                sum += std::pow(double(a.at(x, y, c)) - double(b.at(x, y, c)), 2.0);
    return std::sqrt(sum / (3.0 * a.width * a.height));
}

TEST_F(TruthLaw, TheErrorItEstimatesIsTheErrorItHas) {
    const SceneBuilder scene = makeScene(true);
    Stage stage(device(), scene);
    const auto draw = [&](uint32_t rays, uint32_t seed) {
        return stage.render(
            {.method = "truth", .width = 64, .height = 48, .instants = rays, .seed = seed}
        );
    };
    const auto reference = draw(1024, 1000);
    for (const uint32_t rays : {2u, 16u, 64u}) {
        double estimated = 0.0;
        double actual = 0.0;
        for (uint32_t seed = 0; seed < 4; ++seed) {
            const auto result = draw(rays, seed);
            estimated += std::pow(result.statistics.measures.at("standard error"), 2.0) / 4.0;
            actual += std::pow(computeRms(result.color, reference.color), 2.0) / 4.0;
        }
        EXPECT_GT(actual, 0.0);
        EXPECT_NEAR(std::sqrt(estimated / actual), 1.0, 0.2) << rays << " rays";
    }
}

TEST_F(TruthLaw, TheErrorViewIsWhatTheFigureSumsAndOneRayHasNone) {
    const SceneBuilder scene = makeScene(true);
    const auto result = test::renderOnce(
        device(), scene, {.method = "truth", .width = 61, .height = 43, .aovs = {"error"}}
    );
    const image::Image& error = result.intermediates.at("error");
    const image::Image nothing(61, 43, 4);
    EXPECT_NEAR(computeRms(error, nothing), result.statistics.measures.at("standard error"), 1e-6);
    EXPECT_GT(computeRms(error, nothing), 1e-3);
    const auto one =
        test::renderOnce(device(), scene, {.method = "truth", .instants = 1, .aovs = {"error"}});
    EXPECT_FALSE(one.statistics.measures.contains("standard error"));
    EXPECT_FALSE(one.intermediates.contains("error"));
    EXPECT_EQ(one.statistics.counters.at("rays traced"), 96u * 64u);
}

TEST_F(TruthLaw, BatchesAddUpToTheSamePictureAndSeedsDiffer) {
    const SceneBuilder scene = makeScene(true);
    Stage stage(device(), scene);
    for (const auto pixel : {PixelModel::Centre, PixelModel::Box}) {
        const auto whole = stage.render({.method = "truth", .instants = 13, .pixel = pixel});
        for (const uint32_t batch : {1u, 5u})
            EXPECT_TRUE(test::sameBits(
                whole.color,
                stage.render({.method = "truth", .instants = 13, .batch = batch, .pixel = pixel})
                    .color
            )) << batch;
        const auto other =
            stage.render({.method = "truth", .instants = 13, .seed = 1, .pixel = pixel});
        EXPECT_FALSE(test::sameBits(whole.color, other.color));
    }
}

TEST_F(TruthLaw, TheRasterImageIsNotDrawnUnlessRequested) {
    const SceneBuilder scene = makeScene(true);
    const auto without = test::renderOnce(device(), scene, {.method = "truth"});
    const auto with = test::renderOnce(device(), scene, {.method = "truth", .aovs = {"depth"}});
    EXPECT_FALSE(test::hasPass(without, "G-buffer"));
    EXPECT_TRUE(test::hasPass(with, "G-buffer"));
}

scene::AssetIndex addLit(SceneBuilder& scene) {
    scene::Material material;
    material.baseColorFactor = {0.8f, 0.5f, 0.3f, 1.0f};
    material.roughnessFactor = 0.6f;
    material.metallicFactor = 0.0f;
    return scene.addMaterial(material);
}

scene::Primitive makeRedBox(SceneBuilder& scene, const math::dvec3& size) {
    return test::makeBox(size, scene.addColor({0.9f, 0.2f, 0.1f}));
}

/// What moves before a wall.
struct Moving {
    const char* name;
    void (*add)(SceneBuilder& scene);
    double mostSharp = 40.0; ///< dB of the sharp picture
};

const Moving kMoving[] = {
    {"a spin of more than a turn",
     [](SceneBuilder& scene) {
         scene.addSun({-0.3, -1.0, -0.8}, 2.0f);
         scene.add(
             test::makeBox({2.2, 0.3, 0.3}, addLit(scene)),
             {.position = {0, 0, -3}, .angularVelocity = {0.2, 0.5, 9.0}}
         );
     }},
    {"a camera that moves and turns",
     [](SceneBuilder& scene) {
         scene.add(makeRedBox(scene, {0.4, 3, 0.4}), {.position = {0.5, 0, -2}});
         scene.moveCamera({.velocity = {0.2, 0.05, -0.3}, .angularVelocity = {0.02, 0.25, 0.1}});
     }},
    {"a moved and spinning child of a spinning parent under a moving camera",
     [](SceneBuilder& scene) {
         const ecs::Entity parent = test::addBox(
             scene,
             {0.3, 0.3, 0.3},
             {0.1f, 0.9f, 0.2f},
             {.position = {0, 0, -3}, .velocity = {0.3, 0, 0}, .angularVelocity = {0, 0, 4}}
         );
         const ecs::Entity child = test::addBox(
             scene,
             {0.5, 0.2, 0.2},
             {0.9f, 0.9f, 0.1f},
             {.position = {0.8, 0, 0}, .angularVelocity = {0, 0, -7}}
         );
         scene.world.registry.add(child, scene::Parent{parent});
         scene.moveCamera({.angularVelocity = {0.0, 0.1, 0.0}});
     }},
    {"a mirrored mover, which keeps its sides",
     [](SceneBuilder& scene) {
         scene.addSun({-0.3, -1.0, -0.8}, 2.0f);
         scene.add(
             test::makeBox({0.9, 0.5, 0.5}, addLit(scene)),
             {.position = {0, 0, -3},
              .scale = {-1, 1, 1.5},
              .velocity = {0.8, 0, 0},
              .angularVelocity = {1, 2, 0}}
         );
     }},
    {"holes of a masked mover",
     [](SceneBuilder& scene) {
         scene.add(
             test::makeQuad(2, 2, scene.addWaves(true)),
             {.position = {-0.3, 0, -3}, .velocity = {0.7, 0.1, 0}}
         );
     }},
    {"blended surfaces before and behind a mover",
     [](SceneBuilder& scene) {
         scene.add(
             makeRedBox(scene, {0.6, 0.6, 0.6}), {.position = {0, 0, -3}, .velocity = {0.8, 0, 0}}
         );
         scene.add(
             test::makeQuad(1.5, 1, test::addGlass(scene, {0.1f, 0.3f, 0.9f, 0.4f})),
             {.position = {0, 0, -2}}
         );
         scene.add(
             test::makeQuad(2, 1, test::addGlass(scene, {0.2f, 0.9f, 0.1f, 0.7f})),
             {.position = {0, 0.5, -4}, .velocity = {-0.5, 0, 0}}
         );
     }},
    {"the back of a single-sided mover, which is not seen",
     [](SceneBuilder& scene) {
         test::addCard(
             scene,
             {2, 2},
             {0.9f, 0.2f, 0.1f},
             {.position = {0, 0, -3}, .angularVelocity = {0, 6, 0}}
         );
     }},
    {"a light that moves and turns",
     [](SceneBuilder& scene) {
         scene.add(test::makeQuad(8, 6, addLit(scene)), {.position = {0, 0, -4.9}});
         test::addLight(
             scene,
             {.kind = scene::LightKind::Spot, .intensity = 12.0f, .outerConeAngle = 0.4f},
             {.position = {-1.0, 0.0, -3.0},
              .velocity = {2.0, 0.3, 0.0},
              .angularVelocity = {0.4, 0.8, 0.0}}
         );
     },
     45.0},
    {"a mover that is scaled to nothing at the raster instant and is seen before",
     [](SceneBuilder& scene) {
         const ecs::Entity box = scene.add(makeRedBox(scene, {1, 1, 1}), {.position = {0, 0, -3}});
         // From full size at open to nothing from the middle on, which is the raster instant.
         scene::AnimationChannel channel;
         channel.path = scene::AnimationPath::Scale;
         channel.times = {-0.5f, 0.0f};
         channel.values = {math::vec4(1.0f), math::vec4(0.0f)};
         scene::AnimationClip clip;
         clip.name = "shrink";
         clip.channels = {channel};
         scene.world.assets.clips.push_back(clip);
         scene.world.playback.activeClips.assign(1, true);
         scene.world.registry.add(box, scene::Animated{{{0, 0}}});
     }}};

TEST_F(TruthLaw, RaysAndInstantsSeeTheSameWhateverMoves) {
    for (const Moving& moving : kMoving) {
        SCOPED_TRACE(moving.name);
        SceneBuilder scene = test::makeWavyRoom();
        moving.add(scene);
        Stage stage(device(), scene);
        test::expectTruthsAgree(
            stage,
            {.width = 64,
             .height = 48,
             .background = {0.1f, 0.2f, 0.3f},
             .ambient = math::vec3(0.2f)},
            moving.mostSharp
        );
    }
}

TEST_F(TruthLaw, TheRaysOfTheRevealPassBlendedSurfaces) {
    SceneBuilder scene = test::makeWavyRoom();
    scene.add(
        makeRedBox(scene, {0.6, 0.6, 0.6}), {.position = {0, 0, -3}, .velocity = {0.8, 0, 0}}
    );
    const auto without = test::renderOnce(device(), scene, {.method = "hybrid"});
    // Invisible to raster.
    const scene::AssetIndex glass = test::addGlass(scene, {0.5f, 0.5f, 0.5f, 0.0f});
    scene.add(test::makeQuad(6, 5, glass), {.position = {0, 0, -4}});
    const auto with = test::renderOnce(device(), scene, {.method = "hybrid"});
    EXPECT_TRUE(test::sameBits(without.color, with.color));
}

} // namespace
} // namespace shutter
