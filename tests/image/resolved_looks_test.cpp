// SPDX-License-Identifier: MIT
// Blocks that see one plane are resolved together: as near to the truth as pixels that search each
// for itself, and only where nothing else can be in sight.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

namespace shutter {
namespace {

class ResolvedLooks : public test::GpuTest {
  protected:
    static constexpr uint32_t kWidth = 192;
    static constexpr uint32_t kHeight = 128;

    /// \param uniformMotionPx 0: each pixel searches for itself
    static test::Shot shotOf(std::string_view method, float uniformMotionPx = 0.5f) {
        test::Shot shot{
            .method = method,
            .width = kWidth,
            .height = kHeight,
            .exposureSeconds = 1.0 / 48.0,
            .phase = scene::ShutterPhase::End,
            .instants = 64};
        shot.settings.sampleCount = 15;
        shot.settings.uniformMotionPx = uniformMotionPx;
        return shot;
    }

    /// A wall and posts at three depths before it.
    static test::SceneBuilder makeRoom(const test::Placement& camera) {
        test::SceneBuilder scene;
        scene.setPerspective(0.9);
        scene.moveCamera(camera);
        const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
        scene.add(test::makeQuad(16, 12, waves), {.position = {0, 0, -6}});
        for (const double x : {-1.2, 0.1, 1.0})
            scene.add(test::makeBox({0.1, 3, 0.1}, waves), {.position = {x, 0, -3.0 + x}});
        return scene;
    }

    struct Both {
        render::FrameResult together;
        render::FrameResult each;
        double truthOfTogether = 0.0; ///< PSNR against the truth, dB
        double truthOfEach = 0.0;
    };

    Both drawBoth(const test::SceneBuilder& scene) {
        Both both{
            test::renderOnce(device(), scene, shotOf("resolved")),
            test::renderOnce(device(), scene, shotOf("resolved", 0.0f))};
        const auto truth = test::renderOnce(device(), scene, shotOf("accumulate"));
        both.truthOfTogether = image::computePsnr(both.together.color, truth.color);
        both.truthOfEach = image::computePsnr(both.each.color, truth.color);
        return both;
    }

    static uint64_t countUniform(const render::FrameResult& drawn) {
        return drawn.statistics.counters.at("blocks uniform");
    }
};

TEST_F(ResolvedLooks, ACameraThatTurnsSeesPlanesNearlyEverywhere) {
    const Both both = drawBoth(makeRoom({.angularVelocity = {0.3, 2.0, 0.0}}));
    constexpr uint64_t kBlocks = kWidth * kHeight / 64;
    EXPECT_GT(countUniform(both.together), kBlocks / 2);
    EXPECT_EQ(countUniform(both.each), 0u);
    EXPECT_GT(both.truthOfTogether, both.truthOfEach - 0.3);
}

TEST_F(ResolvedLooks, PostsThatParallaxMovesAreNoPlaneWithTheWall) {
    const Both both = drawBoth(makeRoom({.velocity = {6.0, 0.0, -3.0}}));
    EXPECT_GT(countUniform(both.together), 0u);
    EXPECT_GT(both.truthOfTogether, both.truthOfEach - 0.3);
    // Along the posts' edges, too: the largest difference between the two is one of interpolation.
    const auto anywhere = [](uint32_t, uint32_t) { return true; };
    EXPECT_LT(
        test::computeMaxDifferenceWhere(both.together.color, both.each.color, anywhere), 0.25
    );
}

TEST_F(ResolvedLooks, WhatStandsStillBeforeAMoverIsNotPaintedOver) {
    test::SceneBuilder scene;
    scene.setPerspective(0.9);
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    // Fills the picture at every instant.
    scene.add(
        test::makeQuad(40, 16, waves), {.position = {0, 0, -5}, .velocity = {60.0, 0.0, 0.0}}
    );
    const scene::AssetIndex red = scene.addColor(math::vec3(1.0f, 0.0f, 0.0f));
    scene.add(test::makeBox({0.15, 3, 0.1}, red), {.position = {0.05, 0, -2}});
    const auto drawn = test::renderOnce(device(), scene, shotOf("resolved"));
    const auto sharp = test::renderOnce(device(), scene, shotOf("sharp"));
    EXPECT_GT(countUniform(drawn), 0u);
    const auto isPost = [&](uint32_t x, uint32_t y) {
        const math::vec3 color(
            sharp.color.at(x, y, 0), sharp.color.at(x, y, 1), sharp.color.at(x, y, 2)
        );
        return color.r > 0.0f && color.g == 0.0f && color.b == 0.0f;
    };
    EXPECT_EQ(test::computeMaxDifferenceWhere(drawn.color, sharp.color, isPost), 0.0);
}

TEST_F(ResolvedLooks, FewerInstantsShowNoLessOfWhatMovesLittle) {
    // Two pixels in all: five instants instead of 15 miss no texel.
    const Both both = drawBoth(makeRoom({.angularVelocity = {0.0, 0.5, 0.0}}));
    EXPECT_GT(countUniform(both.together), 0u);
    EXPECT_GT(both.truthOfTogether, both.truthOfEach - 0.3);
}

TEST_F(ResolvedLooks, MoreInstantsThanLooksAreSearchedPixelByPixel) {
    test::Shot shot = shotOf("resolved");
    shot.settings.sampleCount = 33;
    const auto drawn =
        test::renderOnce(device(), makeRoom({.angularVelocity = {0.3, 2.0, 0.0}}), shot);
    EXPECT_EQ(countUniform(drawn), 0u);
}

TEST_F(ResolvedLooks, OrthographicCamerasHaveThemToo) {
    test::SceneBuilder scene;
    scene.setPixelView(kHeight);
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    scene.add(
        test::makeQuad(2.0 * kWidth, 2.0 * kHeight, waves),
        {.position = {0, 0, -10}, .velocity = {600.0, 200.0, 0.0}}
    );
    const auto drawn = test::renderOnce(device(), scene, shotOf("resolved"));
    EXPECT_GT(countUniform(drawn), 0u);
    const auto each = test::renderOnce(device(), scene, shotOf("resolved", 0.0f));
    EXPECT_GT(image::computePsnr(drawn.color, each.color), 45.0);
}

} // namespace
} // namespace shutter
