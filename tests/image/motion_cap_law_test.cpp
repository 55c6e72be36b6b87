// SPDX-License-Identifier: MIT
// A cap on the blur's length shortens motion, of everything in the same way.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>

namespace shutter {
namespace {

using math::dvec3;
using test::SceneBuilder;
using test::Shot;

class MotionCapLaw : public test::GpuTest {};

constexpr double kCapPx = 6.0; // of 96: 6.25 percent

Shot cappedShot(std::string_view method) {
    Shot shot;
    shot.method = method;
    shot.shutter.maxBlurPercent = 100.0 * kCapPx / shot.width;
    shot.aovs = {"motion", "mesh_id"};
    return shot;
}

/// A wall (id 0), a slow mover (1) and a fast one (2); one metre is one pixel.
SceneBuilder makeScene(const dvec3& fast) {
    SceneBuilder scene;
    scene.setPixelView(64);
    scene.add(
        test::makeQuad(300, 200, scene.addTextured(scene.addWaveTexture())),
        {.position = {0, 0, -20}}
    );
    scene.add(
        test::makeQuad(14, 14, scene.addColor({0, 0.4f, 1})),
        {.position = {-28, 0, -10}, .velocity = {0, 5, 0}}
    );
    scene.add(
        test::makeQuad(14, 14, scene.addColor({1, 0.2f, 0})),
        {.position = {20, 0, -10}, .velocity = fast}
    );
    return scene;
}

/// Longest motion vector over the pixels of one id, px.
double findLongest(const render::FrameResult& result, float id) {
    const image::Image& motion = result.intermediates.at("motion");
    const image::Image& ids = result.intermediates.at("mesh_id");
    double longest = 0.0;
    for (uint32_t y = 0; y < ids.height; ++y)
        for (uint32_t x = 0; x < ids.width; ++x)
            if (ids.at(x, y, 0) == id)
                longest =
                    std::max(longest, double(std::hypot(motion.at(x, y, 0), motion.at(x, y, 1))));
    return longest;
}

TEST_F(MotionCapLaw, AMoverBeyondTheCapMovesAsFarAsTheCapAndTheOthersAsBefore) {
    const SceneBuilder scene = makeScene({24, 0, 0});
    const auto capped = test::renderOnce(device(), scene, cappedShot("sharp"));
    EXPECT_EQ(findLongest(capped, 0), 0.0);
    EXPECT_NEAR(findLongest(capped, 1), 5.0, 1e-4);
    EXPECT_NEAR(findLongest(capped, 2), kCapPx, 0.01 * kCapPx);
}

TEST_F(MotionCapLaw, ATurningMoverEndsAtTheCapThoughItsChordIsNoMeasureOfItsAngle) {
    SceneBuilder scene;
    scene.setPixelView(64);
    scene.add(
        test::makeQuad(40, 6, scene.addColor({1, 0.2f, 0})),
        {.position = {0, 0, -10}, .angularVelocity = {0, 0, 3.0}}
    );
    const auto capped = test::renderOnce(device(), scene, cappedShot("sharp"));
    EXPECT_NEAR(findLongest(capped, 0), kCapPx, 0.02 * kCapPx);
}

TEST_F(MotionCapLaw, TheCameraMovesLessForAllThatStandsStillAndMoversKeepTheirWayOnTheScreen) {
    SceneBuilder scene = makeScene({5, 0, 0});
    scene.moveCamera({.velocity = {-10, 0, 0}}); // 10 px; the fast mover 15 px on the screen
    const auto free = [&] {
        Shot shot = cappedShot("sharp");
        shot.shutter.maxBlurPercent = 1000.0;
        return test::renderOnce(device(), scene, shot);
    }();
    EXPECT_NEAR(findLongest(free, 0), 10.0, 1e-3);
    EXPECT_NEAR(findLongest(free, 2), 15.0, 1e-3);
    const auto capped = test::renderOnce(device(), scene, cappedShot("sharp"));
    for (const float id : {0.0f, 1.0f, 2.0f})
        EXPECT_NEAR(findLongest(capped, id), kCapPx, 0.01 * kCapPx) << id;
}

TEST_F(MotionCapLaw, TruthShowsAShorterExposure) {
    // For one mover before a camera at rest, the cap is an exposure in that proportion.
    const SceneBuilder scene = makeScene({24, 0, 0});
    SceneBuilder alone;
    alone.setPixelView(64);
    alone.add(
        test::makeQuad(14, 14, alone.addColor({1, 0.2f, 0})),
        {.position = {20, 0, -10}, .velocity = {24, 0, 0}}
    );
    Shot capped = cappedShot("accumulate");
    capped.instants = 64;
    Shot shorter;
    shorter.method = "accumulate";
    shorter.instants = 64;
    shorter.exposureSeconds = kCapPx / 24.0;
    const auto expected = test::renderOnce(device(), alone, shorter);
    const auto actual = test::renderOnce(device(), alone, capped);
    EXPECT_GE(image::computePsnr(actual.color, expected.color), 60.0);
    if (!device().hasRayQuery())
        return;
    Shot rays = cappedShot("truth");
    rays.instants = 256;
    capped.instants = 256;
    EXPECT_GE(
        image::computePsnr(
            test::renderOnce(device(), scene, rays).color,
            test::renderOnce(device(), scene, capped).color
        ),
        45.0
    );
}

TEST_F(MotionCapLaw, ACapOfZeroIsTheSharpPicture) {
    SceneBuilder scene = makeScene({24, 3, 0});
    scene.moveCamera({.velocity = {-10, 0, 0}});
    const auto sharp = test::renderOnce(device(), scene, {.method = "sharp"});
    for (const std::string_view method : test::listBlurMethods(device())) {
        if (method == "hybrid" && !device().hasRays())
            continue;
        Shot shot = cappedShot(method);
        shot.shutter.maxBlurPercent = 0.0;
        EXPECT_TRUE(test::sameBits(test::renderOnce(device(), scene, shot).color, sharp.color))
            << method;
    }
}

} // namespace
} // namespace shutter
