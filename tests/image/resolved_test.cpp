// SPDX-License-Identifier: MIT
// Looked-up samples: near the truth if a raster holds them; blocks of one plane, crowded tiles, and
// the raster of the exposure's other end.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;

/// 192x128 pixels, 1/48 s that end with the frame.
test::Shot shotOf(std::string_view method, uint32_t instants = 15) {
    test::Shot shot{
        .method = method,
        .width = 192,
        .height = 128,
        .exposureSeconds = 1.0 / 48.0,
        .phase = scene::ShutterPhase::End,
        .instants = instants};
    shot.settings.raysPerPixel = 0.0f;
    return shot;
}

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

    /// A camera that turns about a fence of narrow bars, so that the background moves past them.
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

    static test::Shot fenceShotOf(std::string_view method) {
        test::Shot shot = shotOf(method, method == "accumulate" ? 64 : 15);
        shot.width = 320;
        shot.height = 180;
        shot.exposureSeconds = 1.0 / 60.0;
        shot.phase = scene::ShutterPhase::Centre;
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

TEST_F(Resolved, AMoverBetweenAPostAndAWallIsNearTheTruthWhateverTheCameraDoes) {
    const test::SceneBuilder still = makeScene();
    EXPECT_GT(compareWithTruth(still, shotOf("resolved")), 38.0);
    EXPECT_LT(compareWithTruth(still, paperGather()), 32.0) << "the shot is hard";
    const test::SceneBuilder moving =
        makeScene({.velocity = {1.0, 0.3, -2.0}, .angularVelocity = {0.2, 1.5, 0.6}});
    EXPECT_GT(compareWithTruth(moving, shotOf("resolved")), 32.0);
    EXPECT_LT(compareWithTruth(moving, paperGather()), 31.0) << "the shot is hard";
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

TEST_F(Resolved, SurfacesThatCrossTheCamerasPlaneAreNearTheTruth) {
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

// Both keep rasters: one that runs again must not use outdated history.
TEST_F(Resolved, AnotherMethodInBetweenLeavesNoGhost) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "adaptive needs ray queries";
    const test::SceneBuilder scene = makeScene();
    test::Frames frames(device(), scene);
    const auto draw = [&](int frame, std::string_view method) {
        test::Shot shot = shotOf(method);
        shot.seconds = frame / 48.0;
        shot.frameSeconds = 1.0 / 48.0;
        return frames.draw(shot);
    };
    (void)draw(-1, "resolved");
    const auto expected = draw(0, "resolved");
    EXPECT_GT(expected.statistics.counters.at("samples from the last frame"), 0u);
    (void)draw(-9, "resolved");
    (void)draw(-1, "adaptive");
    EXPECT_TRUE(test::sameBits(draw(0, "resolved").color, expected.color));
}

TEST_F(Resolved, OnlyTilesThatSeeMoreEntitiesThanAListHoldsAreCrowded) {
    test::SceneBuilder scene;
    scene.setPixelView(64);
    const scene::AssetIndex color = scene.addColor(math::vec3(1.0f));
    const scene::AssetIndex mesh = scene.addMesh({test::makeQuad(1, 1, color)});
    // One per pixel of a block of 8 x 8: twice as many as a tile has room for.
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            scene.add(mesh, {.position = {x + 0.5, y + 0.5, -10}, .velocity = {0, 48.0 * 3, 0}});
    test::Shot shot = shotOf("resolved");
    shot.width = shot.height = 64;
    const auto drawn = test::renderOnce(device(), scene, shot);
    EXPECT_GT(drawn.statistics.counters.at("crowded tiles"), 0u);
    EXPECT_TRUE(test::allFinite(drawn.color));
    const auto small = test::renderOnce(device(), makeScene(), shotOf("resolved"));
    EXPECT_EQ(small.statistics.counters.at("crowded tiles"), 0u);
}

class ResolvedLooks : public test::GpuTest {
  protected:
    /// Each pixel searches for itself.
    static test::Shot searchedShot() {
        test::Shot shot = shotOf("resolved");
        shot.settings.uniformMotionPx = 0.0f;
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
            test::renderOnce(device(), scene, searchedShot())};
        const auto truth = test::renderOnce(device(), scene, shotOf("accumulate", 64));
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
    constexpr uint64_t kBlocks = 192 * 128 / 64;
    EXPECT_GT(countUniform(both.together), kBlocks / 2);
    EXPECT_EQ(countUniform(both.each), 0u);
    EXPECT_GT(both.truthOfTogether, both.truthOfEach - 0.3);
    // Two pixels in all: five instants instead of 15 miss no texel.
    const Both slow = drawBoth(makeRoom({.angularVelocity = {0.0, 0.5, 0.0}}));
    EXPECT_GT(countUniform(slow.together), 0u);
    EXPECT_GT(slow.truthOfTogether, slow.truthOfEach - 0.3);
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

TEST_F(ResolvedLooks, StaticSurfacesInFrontOfAMoverAreNotPaintedOver) {
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

TEST_F(ResolvedLooks, InstantsBeyondTheBlockLimitAreSearchedPerPixel) {
    test::Shot shot = shotOf("resolved");
    shot.settings.sampleCount = 33;
    const auto drawn =
        test::renderOnce(device(), makeRoom({.angularVelocity = {0.3, 2.0, 0.0}}), shot);
    EXPECT_EQ(countUniform(drawn), 0u);
}

TEST_F(ResolvedLooks, OrthographicCamerasSeePlanesToo) {
    test::SceneBuilder scene;
    scene.setPixelView(128);
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    scene.add(
        test::makeQuad(384, 256, waves), {.position = {0, 0, -10}, .velocity = {600.0, 200.0, 0.0}}
    );
    const auto drawn = test::renderOnce(device(), scene, shotOf("resolved"));
    EXPECT_GT(countUniform(drawn), 0u);
    const auto each = test::renderOnce(device(), scene, searchedShot());
    EXPECT_GT(image::computePsnr(drawn.color, each.color), 45.0);
}

class ResolvedCrowd : public test::GpuTest {
  protected:
    static constexpr uint32_t kWidth = 96;
    static constexpr uint32_t kHeight = 64;
    static constexpr uint64_t kTiles = (kWidth / 16) * (kHeight / 16);

    static test::Shot shotOf(std::string_view method) {
        test::Shot shot{
            .method = method,
            .width = kWidth,
            .height = kHeight,
            .exposureSeconds = 1.0 / 48.0,
            .phase = scene::ShutterPhase::End,
            .frameSeconds = 1.0 / 24.0,
            .instants = 64};
        shot.settings.sampleCount = 0; // the method's own
        return shot;
    }

    /// 1500 squares of 3.5 pixels before a wall.
    struct Crowd {
        dvec3 together{0.0};      ///< m/s, of all
        double apart = 0.0;       ///< m/s at most, each in another direction
        test::Placement camera{}; ///< of the picture
    };

    static test::SceneBuilder makeCrowd(const Crowd& crowd) {
        const dvec3 kFrom(-3.2, -2.2, -5.5);
        const dvec3 kSize(6.4, 4.4, 2.0);
        test::SceneBuilder scene;
        scene.setPerspective(0.9);
        scene.moveCamera(crowd.camera);
        scene.add(
            test::makeQuad(16, 12, scene.addTextured(scene.addWaveTexture(), true)),
            {.position = {0, 0, -6}}
        );
        // A pixel at the depth of -4.5 m.
        const double side = 3.5 * 4.5 * 2.0 * std::tan(0.45) / kHeight;
        std::mt19937 random(3);
        const auto unit = [&] { return double(random()) / double(std::mt19937::max()); };
        std::vector<scene::AssetIndex> meshes;
        for (int i = 0; i < 8; ++i) {
            const double red = unit();
            const double green = unit();
            const double blue = unit();
            meshes.push_back(scene.addMesh(
                {test::makeQuad(side, side, scene.addColor(math::vec3(red, green, blue)))}
            ));
        }
        for (int i = 0; i < 1500; ++i) {
            test::Placement one;
            for (int axis = 0; axis < 3; ++axis)
                one.position[axis] = kFrom[axis] + unit() * kSize[axis];
            const double angle = unit() * 2.0 * 3.14159265358979;
            const double speed = crowd.apart * std::sqrt(unit());
            one.velocity = crowd.together + speed * dvec3(std::cos(angle), std::sin(angle), 0.0);
            scene.add(meshes[size_t(i) % meshes.size()], one);
        }
        return scene;
    }

    struct Compared {
        double resolved = 0.0; ///< PSNR against the truth, dB
        double filters = 0.0;  ///< the better of own_velocity and gather
        uint64_t crowded = 0;  ///< tiles
    };

    Compared compare(const test::SceneBuilder& scene) {
        const auto truth = test::renderOnce(device(), scene, shotOf("accumulate"));
        const auto drawn = test::renderOnce(device(), scene, shotOf("resolved"));
        const auto psnrOf = [&](const render::FrameResult& frame) {
            return image::computePsnr(frame.color, truth.color);
        };
        return {
            psnrOf(drawn),
            std::max(
                psnrOf(test::renderOnce(device(), scene, shotOf("own_velocity"))),
                psnrOf(test::renderOnce(device(), scene, shotOf("gather")))
            ),
            drawn.statistics.counters.at("crowded tiles")};
    }
};

TEST_F(ResolvedCrowd, CrowdsAreNearerToTheTruthThanFiltersUnderAnyMotion) {
    for (const Crowd& crowd :
         {Crowd{.together = {8.0, 2.0, 0.0}},
          Crowd{.apart = 10.0},
          Crowd{.camera = {.angularVelocity = {0.2, 1.5, 0.3}}},
          Crowd{.camera = {.velocity = {8.0, 0.0, -8.0}}}}) {
        const Compared compared = compare(makeCrowd(crowd));
        EXPECT_GT(compared.crowded, kTiles / 2);
        EXPECT_GT(compared.resolved, compared.filters + 1.0);
    }
}

class SecondRaster : public test::GpuTest {
  protected:
    /// A textured wall, two posts in front of it and two boxes that cross between them: surfaces
    /// that one hides at the exposure's end, and hid a frame before, are visible at its beginning.
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

    static test::Shot secondShot(std::string_view method) {
        test::Shot shot = shotOf(method);
        shot.frameSeconds = 1.0 / 24.0;
        shot.settings.secondRaster = true;
        return shot;
    }

    static bool drawsSecond(const render::FrameResult& frame) {
        return test::hasPass(frame, "second G-buffer");
    }
};

TEST_F(SecondRaster, TheSecondRasterShowsSurfacesHiddenInTheOthers) {
    const test::SceneBuilder scene = makeScene();
    const auto truth = test::renderOnce(device(), scene, shotOf("accumulate"));
    const auto without = test::renderOnce(device(), scene, shotOf("resolved"));
    const auto with = test::renderOnce(device(), scene, secondShot("resolved"));
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

TEST_F(SecondRaster, TheSecondRasterIsAtTheOppositeEndOfTheExposure) {
    const test::SceneBuilder scene = makeScene();
    for (const auto phase : {scene::ShutterPhase::End, scene::ShutterPhase::Start}) {
        test::Shot shot = secondShot("resolved");
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
    const auto resolved = test::renderOnce(device(), scene, secondShot("resolved"));
    const auto adaptive = test::renderOnce(device(), scene, secondShot("adaptive"));
    EXPECT_TRUE(test::sameBits(resolved.color, adaptive.color));
}

TEST_F(SecondRaster, StaticFramesAndFiltersDrawNoSecondRaster) {
    test::SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(test::makeQuad(8, 6, scene.addWaves()), {.position = {0, 0, -5}});
    EXPECT_FALSE(drawsSecond(test::renderOnce(device(), scene, secondShot("resolved"))));
    EXPECT_FALSE(drawsSecond(test::renderOnce(device(), makeScene(), secondShot("gather"))));
}

} // namespace
} // namespace shutter
