// SPDX-License-Identifier: MIT
// Distributed ray tracing against closed forms, and what it says of its own error.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"
#include "tests/support/white_quads.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace shutter {
namespace {

using accumulate::PixelModel;
using test::SceneBuilder;
using test::Stage;

class TruthLaw : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

/// Lit and textured; only a box tumbles, if anything moves.
SceneBuilder makeScene(bool moves) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.addSun({-0.3, -1.0, -0.8}, 2.0f);
    scene.add(
        test::makeQuad(6, 5, scene.addTextured(scene.addWaveTexture())), {.position = {0, 0, -5}}
    );
    test::Placement placement{.position = {0.1, 0, -2.5}};
    if (moves) {
        placement.velocity = {0.6, 0.2, 0.3};
        placement.angularVelocity = {0.3, 2.0, 1.0};
    }
    scene.add(test::makeBox({0.8, 0.8, 0.8}, scene.addMaterial({})), placement);
    return scene;
}

double findLargestColor(const image::Image& picture) {
    return *std::max_element(picture.pixels.begin(), picture.pixels.end());
}

TEST_F(TruthLaw, AStillSceneIsTheSharpPicture) {
    const SceneBuilder scene = makeScene(false);
    Stage stage(device(), scene);
    const auto sharp = stage.render({.ambient = math::vec3(0.3f)});
    const auto rays = stage.render({.method = "truth", .ambient = math::vec3(0.3f), .instants = 4});
    EXPECT_EQ(rays.statistics.measures.at("standard error"), 0.0);
    // The raster image is stored in half floats: 2^-11 of a value. A silhouette that runs through a
    // pixel's centre may fall to either side.
    size_t different = 0;
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 96; ++x)
            for (uint32_t c = 0; c < 3; ++c)
                different += std::abs(sharp.color.at(x, y, c) - rays.color.at(x, y, c)) > 2e-3f;
    EXPECT_LE(different, 12u);
    EXPECT_GT(findLargestColor(rays.color), 0.3);
}

/// Pixels that differ by more than half floats round, of `sharp` and rays.
size_t countDifferent(const image::Image& sharp, const image::Image& rays) {
    size_t different = 0;
    for (uint32_t y = 0; y < sharp.height; ++y)
        for (uint32_t x = 0; x < sharp.width; ++x)
            different += std::abs(sharp.at(x, y, 0) - rays.at(x, y, 0)) > 2e-3f;
    return different;
}

TEST_F(TruthLaw, RaysSeeWhatRasterSeesThroughEveryCamera) {
    using Change = void (*)(SceneBuilder&);
    const auto scaleParent = [](SceneBuilder& scene, const math::dvec3& scale) {
        const ecs::Entity parent = scene.world.registry.create();
        scene.world.registry.add(parent, scene::LocalTransform{{{0, 0, 0}, {1, 0, 0, 0}, scale}});
        scene.world.registry.add(scene.camera, scene::Parent{parent});
    };
    static const auto scaled = scaleParent;
    const std::pair<const char*, Change> cameras[] = {
        {"sheared",
         [](SceneBuilder& scene) {
             scene.world.registry.get<scene::LocalTransform>(scene.camera).transform.rotation =
                 glm::angleAxis(0.4, math::dvec3(0, 0, 1));
             scaled(scene, {1, 3, 1});
         }},
        {"mirrored",
         [](SceneBuilder& scene) {
             scaled(scene, {-1, 1, 1});
         }},
        {"upside down",
         [](SceneBuilder& scene) {
             scaled(scene, {2, -1, 1});
         }},
        {"a wide frame", [](SceneBuilder& scene) { scene.cameraSettings().aspectRatio = 2.5; }},
        {"a wide orthographic frame",
         [](SceneBuilder& scene) {
             scene.setPixelView(4);
             scene.cameraSettings().xMag = 4.0;
         }},
        {"a mirroring frame",
         [](SceneBuilder& scene) {
             scene.setPixelView(4);
             scene.cameraSettings().xMag = -4.0;
         }},
        {"a frame that mirrors twice", [](SceneBuilder& scene) {
             scene.setPixelView(4);
             scene.cameraSettings().xMag = -1.0;
             scene.cameraSettings().yMag = -2.0;
         }}};
    for (const auto& [name, change] : cameras) {
        SceneBuilder scene = makeScene(false);
        change(scene);
        Stage stage(device(), scene);
        const auto sharp = stage.render({.ambient = math::vec3(0.3f)});
        const auto rays =
            stage.render({.method = "truth", .ambient = math::vec3(0.3f), .instants = 2});
        EXPECT_LE(countDifferent(sharp.color, rays.color), 12u) << name;
        EXPECT_GT(findLargestColor(sharp.color), 0.3) << name;
    }
}

TEST_F(TruthLaw, WithoutAnExposureAMoverIsSharpToo) {
    const SceneBuilder scene = makeScene(true);
    Stage stage(device(), scene);
    const auto sharp = stage.render({.exposureSeconds = 0.0});
    const auto rays = stage.render({.method = "truth", .exposureSeconds = 0.0});
    EXPECT_GT(image::computePsnr(sharp.color, rays.color), 50.0);
    EXPECT_EQ(rays.statistics.measures.at("standard error"), 0.0);
}

TEST_F(TruthLaw, AQuadAtConstantSpeedIsTheExactTrapezoidInEachPhase) {
    // Each end of the interval of s is met to a stratum of the 256 of each set.
    test::expectTrapezoidInEachPhase(device(), "truth", 512, 2.0 / 256.0);
}

TEST_F(TruthLaw, AnyNumberOfRaysHasTheTrapezoidForItsMean) {
    // Also counts that are no power of two, and one: over 64 rows the errors average out.
    SceneBuilder scene;
    scene.setPixelView(64);
    scene.add(
        test::makeQuad(16, 100, scene.addColor({1, 1, 1})),
        {.position = {0, 0, -10}, .velocity = {32, 0, 0}}
    );
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

TEST_F(TruthLaw, TheBoxPixelIsTheAreaThatAStillQuadCovers) {
    SceneBuilder scene;
    scene.setPixelView(8);
    scene.add(test::makeQuad(19.3, 20, scene.addColor({1, 1, 1})), {.position = {-0.05, 0, -10}});
    const auto result = test::renderOnce(
        device(), scene, {.method = "truth", .height = 8, .instants = 256, .pixel = PixelModel::Box}
    );
    // An upright edge is met to one of the 128 strata of each set.
    EXPECT_NEAR(result.color.at(37, 4, 0), 0.0, 1e-6);
    EXPECT_NEAR(result.color.at(38, 4, 0), 0.7, 1.0 / 128.0);
    EXPECT_NEAR(result.color.at(39, 4, 0), 1.0, 1e-6);
    EXPECT_NEAR(result.color.at(57, 4, 0), 0.6, 1.0 / 128.0);
    EXPECT_NEAR(result.color.at(58, 4, 0), 0.0, 1e-6);
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

TEST_F(TruthLaw, TheErrorViewIsWhatTheFigureSums) {
    const SceneBuilder scene = makeScene(true);
    const auto result = test::renderOnce(
        device(), scene, {.method = "truth", .width = 61, .height = 43, .aovs = {"error"}}
    );
    const image::Image& error = result.intermediates.at("error");
    const image::Image nothing(61, 43, 4);
    EXPECT_NEAR(computeRms(error, nothing), result.statistics.measures.at("standard error"), 1e-6);
    EXPECT_GT(computeRms(error, nothing), 1e-3);
}

TEST_F(TruthLaw, OneRayHasNoEstimate) {
    const SceneBuilder scene = makeScene(true);
    const auto result =
        test::renderOnce(device(), scene, {.method = "truth", .instants = 1, .aovs = {"error"}});
    EXPECT_FALSE(result.statistics.measures.contains("standard error"));
    EXPECT_FALSE(result.intermediates.contains("error"));
    EXPECT_EQ(result.statistics.counters.at("rays traced"), 96u * 64u);
}

TEST_F(TruthLaw, TwoRunsHaveTheSameBitsAndSeedsAreIndependent) {
    const SceneBuilder scene = makeScene(true);
    Stage stage(device(), scene);
    const auto first = stage.render({.method = "truth"});
    const auto again = stage.render({.method = "truth"});
    const auto other = stage.render({.method = "truth", .seed = 1});
    EXPECT_TRUE(test::sameBits(first.color, again.color));
    EXPECT_FALSE(test::sameBits(first.color, other.color));
}

TEST_F(TruthLaw, BatchesAddUpToTheSamePicture) {
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
    }
}

TEST_F(TruthLaw, OnePixelAndPartialGroupsWork) {
    const SceneBuilder scene = makeScene(true);
    Stage stage(device(), scene);
    for (const auto& [width, height] : {std::pair(1u, 1u), std::pair(9u, 1u), std::pair(3u, 17u)}) {
        const auto result =
            stage.render({.method = "truth", .width = width, .height = height, .instants = 2});
        EXPECT_EQ(result.color.width, width);
        EXPECT_TRUE(test::allFinite(result.color));
        EXPECT_GT(findLargestColor(result.color), 0.05);
        EXPECT_EQ(result.statistics.counters.at("rays traced"), 2u * width * height);
        EXPECT_EQ(result.statistics.counters.at("rays a pixel"), 2u);
    }
}

TEST_F(TruthLaw, AnEmptySceneIsItsBackground) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const auto result =
        test::renderOnce(device(), scene, {.method = "truth", .background = {0.25f, 0.5f, 0.75f}});
    for (uint32_t x = 0; x < 96; ++x)
        ASSERT_EQ(result.color.at(x, 20, 1), 0.5f);
}

TEST_F(TruthLaw, TheRasterImageIsNotDrawnUnlessAsked) {
    const SceneBuilder scene = makeScene(true);
    const auto without = test::renderOnce(device(), scene, {.method = "truth"});
    const auto with = test::renderOnce(device(), scene, {.method = "truth", .aovs = {"depth"}});
    const auto draws = [](const render::FrameResult& result) {
        const auto& passes = result.statistics.passes;
        return std::any_of(passes.begin(), passes.end(), [](const gpu::PassTime& pass) {
            return pass.name == "G-buffer";
        });
    };
    EXPECT_FALSE(draws(without));
    EXPECT_TRUE(draws(with));
}

} // namespace
} // namespace shutter
