// SPDX-License-Identifier: MIT
// What `hybrid` counts: that each surface covers a pixel for its share of the exposure, in shots
// that need one step of the search each.
#include "tests/image/laws.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::CompositeRule;
using test::Placement;
using test::SceneBuilder;
using test::Shot;

class HybridLaw : public test::RayTest {
  protected:
    static Shot shotOf(std::string_view method, scene::ShutterPhase phase) {
        Shot shot{.method = method, .width = 320, .height = 180, .exposureSeconds = 1.0 / 60.0};
        shot.phase = phase;
        return shot;
    }

    struct Scores {
        double counted = 0.0; ///< PSNR of `hybrid`
        double weights = 0.0; ///< PSNR of `hybrid` with the paper's composite
        double gather = 0.0;
    };

    static Scores score(const SceneBuilder& scene, scene::ShutterPhase phase) {
        test::Comparison shot(device(), scene, shotOf("sharp", phase), 64);
        Scores scores{.counted = shot.psnr("hybrid"), .gather = shot.psnr("gather")};
        Shot weights = shotOf("hybrid", phase);
        weights.settings.composite = CompositeRule::Weights;
        scores.weights = shot.psnr(weights);
        return scores;
    }

    static scene::AssetIndex addWall(SceneBuilder& scene) {
        return scene.addTextured(scene.addWaveTexture(), true);
    }

    /// Upright stripes of two colours, as one mesh.
    static scene::AssetIndex addStripes(SceneBuilder& scene, double width, int count) {
        const scene::AssetIndex colors[] = {
            scene.addColor({0.1f, 0.1f, 0.6f}), scene.addColor({0.8f, 0.8f, 0.7f})};
        std::vector<scene::Primitive> stripes;
        for (int i = 0; i < count; ++i)
            stripes.push_back(test::transformed(
                test::makeQuad(width, 20, colors[i % 2]),
                glm::translate(math::dmat4(1.0), dvec3((i - 0.5 * count) * width, 0, 0))
            ));
        return scene.addMesh(std::move(stripes));
    }

    /// Segments of a ring about the z axis, as one mesh.
    static scene::AssetIndex addRing(SceneBuilder& scene, double radius) {
        constexpr int kSegments = 48;
        const scene::AssetIndex color = scene.addColor({0.9f, 0.2f, 0.1f});
        std::vector<scene::Primitive> segments;
        for (int i = 0; i < kSegments; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / kSegments;
            const math::dmat4 turn = glm::rotate(math::dmat4(1.0), angle, dvec3(0, 0, 1));
            segments.push_back(test::transformed(
                test::makeQuad(0.1, 2.2 * radius * std::sin(std::numbers::pi / kSegments), color),
                glm::translate(turn, dvec3(radius, 0, 0))
            ));
        }
        return scene.addMesh(std::move(segments));
    }
};

TEST_F(HybridLaw, AMoverBeforeAStaticWallCoversItForItsShareOfTheExposure) {
    SceneBuilder scene = test::makeView();
    scene.add(test::makeQuad(12, 8, addWall(scene)), {.position = {0, 0, -5}});
    test::addCard(
        scene, {0.3, 0.8}, {0.9f, 0.2f, 0.1f}, {.position = {0, 0, -3}, .velocity = {24, 6, 0}}
    );
    for (const scene::ShutterPhase phase : test::kPhases) {
        const Scores scores = score(scene, phase);
        EXPECT_GT(scores.counted, 42.0);
        EXPECT_GT(scores.counted, scores.gather + 8.0);
        EXPECT_GT(scores.counted, scores.weights + 5.0);
    }
}

TEST_F(HybridLaw, BarsThatACameraPassesHideWhatLiesBehindForTheirShareOfTheExposure) {
    SceneBuilder scene = test::makeView();
    scene.moveCamera({.velocity = {20, 0, 0}});
    scene.add(addStripes(scene, 0.25, 80), {.position = {0, 0, -8}});
    const auto bar = scene.addMesh({test::makeQuad(0.12, 6, scene.addColor({0.1f, 0.8f, 0.1f}))});
    for (int i = -12; i <= 12; ++i)
        scene.add(bar, {.position = {0.5 * i, 0, -3}});
    const Scores scores = score(scene, scene::ShutterPhase::Centre);
    EXPECT_GT(scores.counted, 26.5);
    EXPECT_GT(scores.counted, scores.gather + 5.0);
    EXPECT_GT(scores.counted, scores.weights + 5.0);
}

TEST_F(HybridLaw, ARimThatTurnsFarStaysWhereItIs) {
    for (const double aspect : {0.0, 0.6}) {
        SceneBuilder scene = test::makeView();
        scene.add(test::makeQuad(12, 8, addWall(scene)), {.position = {0, 0, -6}});
        scene.add(
            addRing(scene, 1.1),
            {.position = {0, 0, -4},
             .rotation = glm::angleAxis(aspect, dvec3(0, 1, 0)),
             .angularVelocity = glm::angleAxis(aspect, dvec3(0, 1, 0)) * dvec3(0, 0, 50)}
        );
        for (const scene::ShutterPhase phase : test::kPhases) {
            const Scores scores = score(scene, phase);
            EXPECT_GT(scores.counted, scores.gather + 6.0);
            EXPECT_GT(scores.counted, 36.0);
        }
    }
}

TEST_F(HybridLaw, ASlowMoverNextToAFastOneIsBlurredByItsOwnMotion) {
    SceneBuilder scene = test::makeView();
    scene.add(test::makeQuad(12, 8, addWall(scene)), {.position = {0, 0, -5}});
    test::addCard(
        scene, {0.5, 0.5}, {0.9f, 0.2f, 0.1f}, {.position = {-0.1, 0.7, -3}, .velocity = {24, 0, 0}}
    );
    test::addCard(
        scene, {0.2, 0.5}, {0.1f, 0.8f, 0.1f}, {.position = {0, 0, -3}, .velocity = {11, 0, 0}}
    );
    const Scores scores = score(scene, scene::ShutterPhase::End);
    EXPECT_GT(scores.counted, 48.0);
    EXPECT_GT(scores.counted, scores.gather + 15.0);
}

TEST_F(HybridLaw, AStaticPostBeforeAMovingWallIsNoWiderThanItIs) {
    SceneBuilder scene = test::makeView();
    scene.add(
        test::makeQuad(12, 8, scene.addColor({0.1f, 0.1f, 0.6f})),
        {.position = {0, 0, -5}, .velocity = {20, 0, 0}}
    );
    test::addCard(scene, {0.2, 6}, {0.1f, 0.8f, 0.1f}, {.position = {0, 0, -3}});
    test::Comparison shot(device(), scene, shotOf("sharp", scene::ShutterPhase::End), 16);
    EXPECT_GT(shot.psnr("hybrid"), 60.0);
}

TEST_F(HybridLaw, EdgesThatSpanThePictureUncoverWhatLiesBehindThem) {
    for (const bool isUpright : {true, false}) {
        SceneBuilder scene = test::makeView();
        scene.add(test::makeQuad(12, 8, addWall(scene)), {.position = {0, 0, -5}});
        test::addCard(
            scene,
            isUpright ? math::dvec2(0.5, 20.0) : math::dvec2(20.0, 0.5),
            {0.9f, 0.2f, 0.1f},
            {.position = {0, 0, -3}, .velocity = isUpright ? dvec3(24, 0, 0) : dvec3(0, 24, 0)}
        );
        const Scores scores = score(scene, scene::ShutterPhase::End);
        EXPECT_GT(scores.counted, scores.gather + 8.0) << isUpright;
    }
}

TEST_F(HybridLaw, AMoverNextToAFasterOneWithAnotherDirectionCoversAndUncoversWhatLiesBehind) {
    for (const dvec3 velocity : {dvec3(0, 26, 0), dvec3(-26, 0, 0)}) {
        SceneBuilder scene = test::makeView();
        scene.add(test::makeQuad(12, 8, addWall(scene)), {.position = {0, 0, -5}});
        test::addCard(
            scene, {1.2, 2.0}, {0.9f, 0.2f, 0.1f}, {.position = {0, 0, -3}, .velocity = {22, 0, 0}}
        );
        test::addCard(
            scene, {0.1, 0.1}, {0.1f, 0.8f, 0.1f}, {.position = {0, 0, -2.9}, .velocity = velocity}
        );
        const Scores scores = score(scene, scene::ShutterPhase::End);
        EXPECT_GT(scores.counted, 37.0);
        EXPECT_GT(scores.counted, scores.gather + 7.0);
    }
}

TEST_F(HybridLaw, APostThatMovesSlowlyBeforeAFastBackgroundIsBlurredByItsOwnMotion) {
    SceneBuilder scene = test::makeView();
    scene.add(
        test::makeQuad(20, 8, addWall(scene)), {.position = {0, 0, -6}, .velocity = {50, 0, 0}}
    );
    test::addCard(
        scene, {0.1, 20}, {0.1f, 0.8f, 0.1f}, {.position = {0, 0, -3}, .velocity = {-4, 0, 0}}
    );
    const Scores scores = score(scene, scene::ShutterPhase::Centre);
    EXPECT_GT(scores.counted, scores.gather + 6.0);
}

TEST_F(HybridLaw, WithoutRaysTheBackgroundIsGuessedFromTheRaster) {
    SceneBuilder scene = test::makeView();
    scene.add(addStripes(scene, 0.2, 60), {.position = {0, 0, -5}});
    test::addCard(
        scene, {0.3, 0.8}, {0.9f, 0.2f, 0.1f}, {.position = {0, 0, -3}, .velocity = {24, 6, 0}}
    );
    Shot shot = shotOf("hybrid", scene::ShutterPhase::Centre);
    test::Comparison compared(device(), scene, shot, 64);
    const double traced = compared.psnr(shot);
    shot.settings.rayShare = 0.0f;
    const double guessed = compared.psnr(shot);
    EXPECT_GT(guessed, 33.0);
    EXPECT_GT(traced, guessed + 2.0);
}

TEST_F(HybridLaw, WhatIsTooDeepToMoveIsUncoveredByWhatIsNot) {
    SceneBuilder scene = test::makeView();
    scene.moveCamera({.angularVelocity = {0, 5, 0}});
    scene.add(test::makeQuad(12, 8, addWall(scene)), {.position = {0, 0, -5}});
    test::addCard(scene, {0.3, 0.8}, {0.9f, 0.2f, 0.1f}, {.position = {0, 0, -3}});
    Shot shot = shotOf("hybrid", scene::ShutterPhase::Centre);
    const auto countMasked = [&] {
        const image::Image mask = test::renderOnce(device(), scene, shot).intermediates.at("mask");
        return std::count_if(mask.pixels.begin(), mask.pixels.end(), [](float m) {
            return m > 0.5f;
        });
    };
    shot.aovs = {"mask"};
    EXPECT_EQ(countMasked(), 0);
    shot.settings.maxMotionDepth = 4.0f;
    EXPECT_GT(countMasked(), 500);
}

TEST_F(HybridLaw, AFloorThatACameraDrivesOverIsBlurredByTheMotionOfEachOfItsPoints) {
    SceneBuilder scene = test::makeView();
    scene.moveCamera({.position = {0, 1, 0}, .velocity = {0, 0, -14}});
    scene.add(
        test::makeQuad(40, 40, addWall(scene)),
        {.rotation = glm::angleAxis(-std::numbers::pi / 2.0, dvec3(1, 0, 0))}
    );
    test::addCard(scene, {0.1, 2}, {0.9f, 0.2f, 0.1f}, {.position = {0.4, 1, -2.5}});
    const Scores scores = score(scene, scene::ShutterPhase::Start);
    EXPECT_GT(scores.counted, 40.0);
    EXPECT_GT(scores.counted, scores.gather + 6.0);
}

} // namespace
} // namespace shutter
