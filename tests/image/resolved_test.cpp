// SPDX-License-Identifier: MIT
// What a pixel saw, looked up: near the truth where this frame or the last one holds it, and honest
// about where neither does.
#include "engine/image/metrics.h"
#include "engine/render/renderer.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

namespace shutter {
namespace {

using math::dvec3;

class Resolved : public test::GpuTest {
  protected:
    /// A textured wall, a post before it and a box that passes between them.
    static test::SceneBuilder makeScene(const test::Placement& camera = {}) {
        test::SceneBuilder scene;
        scene.setPerspective(0.9);
        scene.moveCamera(camera);
        const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
        scene.add(test::makeQuad(8, 6, waves), {.position = {0, 0, -5}});
        scene.add(test::makeBox({0.15, 3, 0.1}, waves), {.position = {0.4, 0, -2}});
        scene.add(
            test::makeBox({0.8, 0.6, 0.5}, scene.addWaves()),
            {.position = {-0.3, 0, -3}, .velocity = {12.0, 2.0, 0.0}}
        );
        return scene;
    }

    /// A camera that turns about a fence of narrow bars, so that what is behind them runs past.
    static test::SceneBuilder makeFence(bool hasWall) {
        test::SceneBuilder scene;
        scene.setPerspective(0.785);
        scene.moveCamera(
            {.position = {0, 0, 4},
             .velocity = {10.0, 0.0, 0.0},
             .angularVelocity = {0.0, 1.0, 0.0}}
        );
        const scene::AssetIndex green = scene.addColor({0.0f, 1.0f, 0.0f});
        const scene::AssetIndex bar = scene.addMesh({test::makeQuad(0.25, 20, green)});
        for (int i = -14; i <= 14; ++i)
            scene.add(bar, {.position = {i * 0.5, 0, -6}});
        if (hasWall)
            scene.add(
                test::makeQuad(200, 200, scene.addColor({0.1f, 0.1f, 0.6f})),
                {.position = {0, 0, -30}}
            );
        return scene;
    }

    static test::Shot shotOf(std::string_view method) {
        return {
            .method = method,
            .width = 192,
            .height = 128,
            .exposureSeconds = 1.0 / 48.0,
            .phase = scene::ShutterPhase::End,
            .instants = 15};
    }

    static test::Shot fenceShotOf(std::string_view method) {
        test::Shot shot = shotOf(method);
        shot.width = 320;
        shot.height = 180;
        shot.exposureSeconds = 1.0 / 60.0;
        shot.phase = scene::ShutterPhase::Centre;
        shot.instants = method == "accumulate" ? 64 : 15;
        return shot;
    }

    /// The gather with the paper's numbers: how hard a shot is.
    static test::Shot paperGather() {
        test::Shot shot = shotOf("gather");
        shot.settings = motion_blur::paperSettings();
        return shot;
    }

    double compareWithTruth(const test::SceneBuilder& scene, const test::Shot& shot) {
        const auto truth = test::renderOnce(device(), scene, shotOf("accumulate"));
        return image::computePsnr(test::renderOnce(device(), scene, shot).color, truth.color);
    }
};

TEST_F(Resolved, AMoverBetweenAPostAndAWallIsNearTheTruth) {
    const test::SceneBuilder scene = makeScene();
    EXPECT_GT(compareWithTruth(scene, shotOf("resolved")), 38.0);
    EXPECT_LT(compareWithTruth(scene, paperGather()), 32.0) << "the shot is hard";
}

TEST_F(Resolved, SoItIsUnderACameraThatMovesAndTurns) {
    const test::SceneBuilder scene =
        makeScene({.velocity = {1.0, 0.3, -2.0}, .angularVelocity = {0.2, 1.5, 0.6}});
    EXPECT_GT(compareWithTruth(scene, shotOf("resolved")), 32.0);
    EXPECT_LT(compareWithTruth(scene, paperGather()), 31.0) << "the shot is hard";
}

TEST_F(Resolved, ABackgroundThatBarsHideKeepsItsOwnColor) {
    for (const bool hasWall : {false, true}) {
        const test::SceneBuilder scene = makeFence(hasWall);
        const auto truth = test::renderOnce(device(), scene, fenceShotOf("accumulate")).color;
        const auto psnrOf = [&](const test::Shot& shot) {
            return image::computePsnr(test::renderOnce(device(), scene, shot).color, truth);
        };
        const double resolved = psnrOf(fenceShotOf("resolved"));
        for (const char* method : {"sharp", "own_velocity", "gather", "guertin2014"})
            EXPECT_GT(resolved, psnrOf(fenceShotOf(method))) << method << ", wall " << hasWall;
        test::Shot alone = fenceShotOf("resolved");
        alone.settings.history = false;
        EXPECT_GT(psnrOf(alone), psnrOf(fenceShotOf("gather"))) << "wall " << hasWall;
    }
}

// Each raster knows an edge to half a pixel. What any of them shows must not count as there: movers
// would be too wide, and the picture would have too much of their colour.
TEST_F(Resolved, EdgesInTwoRastersMakeNoMoverWider) {
    const test::SceneBuilder scene = makeFence(false);
    const auto greenOf = [&](const test::Shot& shot) {
        const image::Image picture = test::renderOnce(device(), scene, shot).color;
        double sum = 0.0;
        for (uint32_t y = 0; y < picture.height; ++y)
            for (uint32_t x = 0; x < picture.width; ++x)
                sum += picture.at(x, y, 1);
        return sum / (picture.width * picture.height);
    };
    const double expected = greenOf(fenceShotOf("accumulate"));
    EXPECT_NEAR(greenOf(fenceShotOf("resolved")) / expected, 1.0, 0.01);
}

TEST_F(Resolved, SoIsWhatPassesTheCamerasPlane) {
    test::SceneBuilder scene;
    scene.setPerspective(1.4);
    scene.moveCamera({.velocity = {4.0, 0.0, -60.0}});
    const scene::AssetIndex waves = scene.addWaves();
    // Floor, ceiling and wall begin behind the camera and end far ahead: tiles at the picture's
    // border have depths down to 0 at some instant.
    scene.add(test::makeBox({60, 0.1, 60}, waves), {.position = {0, -0.5, 0}});
    scene.add(test::makeBox({60, 0.1, 60}, waves), {.position = {0, 1.5, 0}});
    scene.add(test::makeBox({0.1, 8, 60}, waves), {.position = {2.0, 0, 0}});
    EXPECT_GT(compareWithTruth(scene, shotOf("resolved")), 36.0);
    EXPECT_LT(compareWithTruth(scene, paperGather()), 24.0) << "the shot is hard";
}

TEST_F(Resolved, TheLastFrameHoldsWhatThisOneHides) {
    const test::SceneBuilder scene = makeScene();
    test::Shot without = shotOf("resolved");
    without.settings.history = false;
    const auto alone = test::renderOnce(device(), scene, without);
    const auto both = test::renderOnce(device(), scene, shotOf("resolved"));
    EXPECT_EQ(alone.statistics.counters.at("history bytes"), 0u);
    EXPECT_EQ(alone.statistics.counters.at("samples from the last frame"), 0u);
    EXPECT_GT(both.statistics.counters.at("samples from the last frame"), 0u);
    // Two rasters in turns, each of a half-float colour and two floats per pixel.
    EXPECT_EQ(both.statistics.counters.at("history bytes"), 2u * 192u * 128u * 16u);
    EXPECT_LT(
        both.statistics.counters.at("unresolved samples"),
        alone.statistics.counters.at("unresolved samples") / 4
    );
}

// Both keep rasters: one that runs again must not take what it kept long ago for the last frame's.
TEST_F(Resolved, AnotherMethodInBetweenLeavesNoGhost) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "adaptive needs ray queries";
    const test::SceneBuilder scene = makeScene();
    render::Renderer renderer(device(), scene.world.assets);
    motion_blur::MotionBlurPlugin blur(device(), renderer.scene(), {});
    const auto draw = [&](int frame, std::string_view method) {
        motion_blur::MotionBlurSettings settings;
        settings.method = &motion_blur::getMethod(method);
        blur.configure(settings, {});
        render::FrameRequest request;
        request.view.camera = scene.camera;
        request.view.exposure = scene::computeExposure({1.0 / 48.0}, frame / 48.0, 1.0 / 48.0);
        request.view.width = 192;
        request.view.height = 128;
        render::PostEffect* effects[] = {&blur};
        auto drawn = renderer.renderFrame(scene.world, request, effects);
        EXPECT_TRUE(drawn.ok());
        return std::move(drawn.value());
    };
    (void)draw(-1, "resolved");
    const auto expected = draw(0, "resolved");
    EXPECT_GT(expected.statistics.counters.at("samples from the last frame"), 0u);
    (void)draw(-9, "resolved");
    (void)draw(-1, "adaptive");
    EXPECT_TRUE(test::sameBits(draw(0, "resolved").color, expected.color));
}

TEST_F(Resolved, ASmallSceneHasNoCrowdedTiles) {
    const auto drawn = test::renderOnce(device(), makeScene(), shotOf("resolved"));
    EXPECT_EQ(drawn.statistics.counters.at("crowded tiles"), 0u);
}

TEST_F(Resolved, TilesThatSeeMoreEntitiesThanAListHoldsAreCounted) {
    test::SceneBuilder scene;
    scene.setPixelView(64);
    const scene::AssetIndex color = scene.addColor(math::vec3(1.0f));
    const scene::AssetIndex mesh = scene.addMesh({test::makeQuad(1, 1, color)});
    // One a pixel of a block of 8 x 8: twice as many as a tile has room for.
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            scene.add(mesh, {.position = {x + 0.5, y + 0.5, -10}, .velocity = {0, 48.0 * 3, 0}});
    test::Shot shot = shotOf("resolved");
    shot.width = shot.height = 64;
    const auto drawn = test::renderOnce(device(), scene, shot);
    EXPECT_GT(drawn.statistics.counters.at("crowded tiles"), 0u);
    EXPECT_TRUE(test::allFinite(drawn.color));
}

} // namespace
} // namespace shutter
