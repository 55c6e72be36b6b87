// SPDX-License-Identifier: MIT
// A raster of the exposure's other end (`secondRaster`) as a third layer of `resolved` and
// `adaptive`: what it shows that the others hide, and that nothing of it is there unless it is
// read.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>

namespace shutter {
namespace {

class SecondRaster : public test::GpuTest {
  protected:
    /// A textured wall, two posts that stand before it and two boxes that cross between them: what
    /// one hides at the exposure's end, and hid a frame before, it shows at its beginning.
    static test::SceneBuilder makeScene() {
        test::SceneBuilder scene;
        scene.setPerspective(0.9);
        const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
        scene.add(test::makeQuad(8, 6, waves), {.position = {0, 0, -5}});
        scene.add(
            test::makeBox({0.8, 0.6, 0.5}, scene.addWaves()),
            {.position = {-0.3, 0, -3}, .velocity = {12.0, 2.0, 0.0}}
        );
        scene.add(
            test::makeBox({1.2, 0.2, 0.2}, scene.addWaves()),
            {.position = {0.2, 0.1, -2.5}, .angularVelocity = {0, 0, 60}}
        );
        return scene;
    }

    static test::Shot shotOf(std::string_view method, bool hasSecond = false) {
        test::Shot shot{
            .method = method,
            .width = 192,
            .height = 128,
            .exposureSeconds = 1.0 / 48.0,
            .phase = scene::ShutterPhase::End,
            .frameSeconds = 1.0 / 24.0,
            .instants = 15};
        shot.settings.secondRaster = hasSecond;
        shot.settings.raysPerPixel = 0.0f;
        return shot;
    }

    static bool drawsSecond(const render::FrameResult& frame) {
        const auto& passes = frame.statistics.passes;
        return std::any_of(passes.begin(), passes.end(), [](const render::PassTime& pass) {
            return pass.name == "second G-buffer";
        });
    }
};

TEST_F(SecondRaster, ItShowsWhatTheOthersHide) {
    const test::SceneBuilder scene = makeScene();
    const auto truth = test::renderOnce(device(), scene, shotOf("accumulate"));
    const auto without = test::renderOnce(device(), scene, shotOf("resolved"));
    const auto with = test::renderOnce(device(), scene, shotOf("resolved", true));
    EXPECT_FALSE(drawsSecond(without));
    EXPECT_TRUE(drawsSecond(with));
    EXPECT_EQ(without.statistics.counters.at("samples from the second raster"), 0u);
    EXPECT_GT(with.statistics.counters.at("samples from the second raster"), 0u);
    EXPECT_LT(
        with.statistics.counters.at("unresolved samples"),
        without.statistics.counters.at("unresolved samples") / 2
    );
    EXPECT_GT(
        image::computePsnr(with.color, truth.color),
        image::computePsnr(without.color, truth.color) + 1.0
    );
}

TEST_F(SecondRaster, ItIsTheBeginningWhereTheRasterIsTheEndAndTheOtherWayRound) {
    const test::SceneBuilder scene = makeScene();
    for (const auto phase : {scene::ShutterPhase::End, scene::ShutterPhase::Start}) {
        test::Shot shot = shotOf("resolved", true);
        shot.phase = phase;
        shot.aovs = {"second"};
        const auto drawn = test::renderOnce(device(), scene, shot);
        test::Shot sharp = shotOf("sharp");
        sharp.phase = phase;
        sharp.instant = phase == scene::ShutterPhase::End ? 0.0 : 1.0;
        const auto expected = test::renderOnce(device(), scene, sharp);
        EXPECT_TRUE(test::sameBits(drawn.intermediates.at("second"), expected.color));
    }
}

TEST_F(SecondRaster, AdaptiveWithoutRaysIsResolved) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "adaptive needs ray queries";
    const test::SceneBuilder scene = makeScene();
    const auto resolved = test::renderOnce(device(), scene, shotOf("resolved", true));
    const auto adaptive = test::renderOnce(device(), scene, shotOf("adaptive", true));
    EXPECT_TRUE(test::sameBits(resolved.color, adaptive.color));
}

TEST_F(SecondRaster, AFrameThatStandsStillDrawsNone) {
    test::SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(test::makeQuad(8, 6, scene.addWaves()), {.position = {0, 0, -5}});
    EXPECT_FALSE(drawsSecond(test::renderOnce(device(), scene, shotOf("resolved", true))));
}

TEST_F(SecondRaster, AMethodThatLooksNothingUpDrawsNone) {
    EXPECT_FALSE(drawsSecond(test::renderOnce(device(), makeScene(), shotOf("gather", true))));
}

} // namespace
} // namespace shutter
