// SPDX-License-Identifier: MIT
// The brute-force truth against closed forms, and its convergence.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"
#include "tests/support/white_quads.h"

#include <algorithm>

namespace shutter {
namespace {

using accumulate::PixelModel;
using test::SceneBuilder;
using test::Stage;

class AccumulateLaw : public test::GpuTest {};

TEST_F(AccumulateLaw, AQuadAtConstantSpeedIsTheExactTrapezoid) {
    // An end of the interval of s is met to half a stratum: two ends, 1/512 < 1/255.
    test::expectTrapezoidInEachPhase(device(), "accumulate", 512, 1.0 / 255.0);
}

TEST_F(AccumulateLaw, TheBoxPixelIsTheAreaThatAStillQuadCovers) {
    // Silhouettes at 38.3 and 57.6: the pixels they cross are covered by 0.7 and 0.6.
    SceneBuilder scene;
    scene.setPixelView(8);
    scene.add(test::makeQuad(19.3, 20, scene.addColor({1, 1, 1})), {.position = {-0.05, 0, -10}});
    const auto result = test::renderOnce(
        device(),
        scene,
        {.method = "accumulate", .height = 8, .instants = 256, .pixel = PixelModel::Box}
    );
    // Hammersley's first 256 radical inverses of base 2 are the multiples of 1/256: the count to
    // one side of an edge is right to one.
    EXPECT_NEAR(result.color.at(37, 4, 0), 0.0, 1.0 / 256.0);
    EXPECT_NEAR(result.color.at(38, 4, 0), 0.7, 1.0 / 256.0);
    EXPECT_NEAR(result.color.at(39, 4, 0), 1.0, 1.0 / 256.0);
    EXPECT_NEAR(result.color.at(57, 4, 0), 0.6, 1.0 / 256.0);
    EXPECT_NEAR(result.color.at(58, 4, 0), 0.0, 1.0 / 256.0);
}

SceneBuilder makeScene() {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeQuad(6, 5, scene.addTextured(scene.addWaveTexture())), {.position = {0, 0, -5}}
    );
    scene.add(
        test::makeBox({0.8, 0.8, 0.8}, scene.addColor({0.9f, 0.2f, 0.1f})),
        {.position = {0.1, 0, -2.5},
         .velocity = {0.6, 0.2, 0.3},
         .angularVelocity = {0.3, 2.0, 1.0}}
    );
    return scene;
}

TEST_F(AccumulateLaw, MoreInstantsComeNearerToTheMean) {
    const SceneBuilder scene = makeScene();
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

TEST_F(AccumulateLaw, OneInstantIsTheSharpPictureOfTheMiddle) {
    const SceneBuilder scene = makeScene();
    Stage stage(device(), scene);
    const auto sharp = stage.render({});
    const auto one = stage.render({.method = "accumulate", .instants = 1});
    EXPECT_TRUE(test::sameBits(sharp.color, one.color));
}

/// One metre is one pixel.
uint64_t countInstants(gpu::Device& device, const test::Placement& placement) {
    SceneBuilder scene;
    scene.setPixelView(64);
    scene.add(test::makeQuad(40, 6, scene.addColor({1, 1, 1})), placement);
    const auto result = test::renderOnce(
        device, scene, {.method = "accumulate", .instants = 1024, .maxStepPx = 1.0}
    );
    return result.statistics.counters.at("instants");
}

TEST_F(AccumulateLaw, InstantsFollowTheLongestWay) {
    EXPECT_EQ(countInstants(device(), {.position = {0, 0, -10}}), 1u);
    const uint64_t straight =
        countInstants(device(), {.position = {0, 0, -10}, .velocity = {11.5, 0, 0}});
    EXPECT_EQ(straight, 12u);
}

TEST_F(AccumulateLaw, ATurnCountsThoughItEndsWhereItBegan) {
    const double turn = 2.0 * 3.14159265358979;
    const uint64_t instants =
        countInstants(device(), {.position = {0, 0, -10}, .angularVelocity = {0, 0, turn}});
    // Corners go 127 px; chords of the parts are up to a tenth shorter, pixels' centres lie within.
    EXPECT_GT(instants, 105u);
    EXPECT_LE(instants, 128u);
}

TEST_F(AccumulateLaw, AStillFrameByItsOwnInstantsIsTheSharpPicture) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeQuad(6, 5, scene.addTextured(scene.addWaveTexture())), {.position = {0, 0, -5}}
    );
    Stage stage(device(), scene);
    const auto sharp = stage.render({});
    const auto own = stage.render({.method = "accumulate", .instants = 1024, .maxStepPx = 1.0});
    EXPECT_TRUE(test::sameBits(sharp.color, own.color));
    EXPECT_EQ(own.statistics.counters.at("instants"), 1u);
}

} // namespace
} // namespace shutter
