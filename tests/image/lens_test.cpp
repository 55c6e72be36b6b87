// SPDX-License-Identifier: MIT
// The lens, in the methods that have one: surfaces in focus stay sharp, a point of light becomes
// the image of the opening, and both truths see the same.
#include "engine/image/metrics.h"
#include "engine/scene/lens.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using scene::CameraLens;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

constexpr double kLensYFov = 0.9;

class LensLaw : public test::GpuTest {};

/// A wall of waves at 5 m, a white box before it that tumbles, if anything moves.
SceneBuilder makeRoom(const CameraLens& lens, bool moves = false) {
    SceneBuilder scene;
    scene.setPerspective(kLensYFov);
    scene.world.registry.add(scene.camera, lens);
    scene.add(test::makeQuad(14, 9, scene.addWaves()), {.position = {0, 0, -5}});
    test::Placement box{.position = {0.2, 0.1, -2}};
    if (moves) {
        box.velocity = {0.5, 0.2, 0.3};
        box.angularVelocity = {0.3, 2.0, 1.0};
    }
    scene.add(test::makeBox({0.6, 0.6, 0.6}, scene.addColor({0.9f, 0.8f, 0.7f})), box);
    return scene;
}

TEST_F(LensLaw, AClosedLensIsThePinholeToTheBit) {
    std::vector<std::string_view> methods{"accumulate", "resolved"};
    if (device().hasRayQuery())
        methods.insert(methods.end(), {"truth", "denoised"});
    for (const std::string_view method : methods) {
        Shot shot{.method = method, .width = 48, .height = 32};
        SceneBuilder scene = makeRoom({}, true);
        scene.world.registry.remove<CameraLens>(scene.camera);
        Stage stage(device(), scene);
        const render::FrameResult pinhole = stage.render(shot);
        for (const CameraLens& lens :
             {CameraLens{.fStop = 0.0}, CameraLens{.fStop = 0.5, .blurScale = 0.0}}) {
            scene.world.registry.add(scene.camera, lens);
            const render::FrameResult closed = stage.render(shot);
            EXPECT_TRUE(test::sameBits(closed.color, pinhole.color)) << method;
            EXPECT_EQ(closed.statistics.passes.size(), pinhole.statistics.passes.size()) << method;
        }
        scene.world.registry.add(scene.camera, CameraLens{.fStop = 0.5, .focusDistance = 5.0});
        EXPECT_FALSE(test::sameBits(stage.render(shot).color, pinhole.color)) << method;
    }
}

TEST_F(LensLaw, ResolvedTakesALensThatLeavesAllInFocusForThePinhole) {
    const Shot shot{.method = "resolved", .width = 48, .height = 32};
    for (const bool moves : {false, true}) {
        SceneBuilder scene = makeRoom({.fStop = 8.0, .focusDistance = 3.0}, moves);
        Stage stage(device(), scene);
        const render::FrameResult open = stage.render(shot);
        scene.world.registry.remove<CameraLens>(scene.camera);
        const render::FrameResult pinhole = stage.render(shot);
        EXPECT_TRUE(test::sameBits(open.color, pinhole.color)) << moves;
        EXPECT_EQ(open.statistics.passes.size(), pinhole.statistics.passes.size()) << moves;
    }
}

TEST_F(LensLaw, MethodsWithoutALensDrawThePinhole) {
    SceneBuilder scene = makeRoom({.fStop = 0.5, .focusDistance = 5.0}, true);
    Stage stage(device(), scene);
    for (const std::string_view method : {"sharp", "own_velocity", "gather"}) {
        const Shot shot{.method = method, .width = 48, .height = 32};
        const image::Image open = stage.render(shot).color;
        scene.world.registry.remove<CameraLens>(scene.camera);
        EXPECT_TRUE(test::sameBits(open, stage.render(shot).color)) << method;
        scene.world.registry.add(scene.camera, CameraLens{.fStop = 0.5, .focusDistance = 5.0});
    }
}

TEST_F(LensLaw, APlaneInFocusIsSharpAndSurfacesOfOneColourStayIt) {
    SceneBuilder scene;
    scene.setPerspective(kLensYFov);
    scene.world.registry.add(scene.camera, CameraLens{.fStop = 0.5, .focusDistance = 5.0});
    scene.add(test::makeQuad(20, 14, scene.addWaves()), {.position = {0, 0, -5}});
    Stage stage(device(), scene);
    const image::Image sharp = stage.render({.width = 64, .height = 36}).color;
    const image::Image seen =
        stage.render({.method = "accumulate", .width = 64, .height = 36, .instants = 64}).color;
    EXPECT_LT(
        test::computeMaxDifferenceWhere(sharp, seen, [](uint32_t, uint32_t) { return true; }), 4e-3
    );

    SceneBuilder grey;
    grey.setPerspective(kLensYFov);
    grey.world.registry.add(grey.camera, CameraLens{.fStop = 0.5, .focusDistance = 3.0});
    for (const double z : {-1.0, -3.0, -9.0})
        grey.add(test::makeQuad(1, 1, grey.addColor({0.5f, 0.5f, 0.5f})), {.position = {0, 0, z}});
    const image::Image flat = test::renderOnce(
                                  device(),
                                  grey,
                                  {.method = "accumulate",
                                   .width = 64,
                                   .height = 36,
                                   .background = math::vec3(0.5f),
                                   .instants = 64}
    )
                                  .color;
    for (uint32_t y = 0; y < 36; ++y)
        for (uint32_t x = 0; x < 64; ++x)
            ASSERT_NEAR(flat.at(x, y, 1), 0.5f, 1e-4f) << x << " " << y;
}

/// Of a picture's light.
struct Spot {
    math::dvec2 centre{0.0};
    math::dvec2 variance{0.0};
    double skew = 0.0; ///< third moment to the right
};

Spot measureSpot(const image::Image& picture) {
    Spot spot;
    spot.centre = test::computeCentroid(picture);
    double light = 0.0;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const double value = picture.at(x, y, 1);
            const math::dvec2 from = math::dvec2(x + 0.5, y + 0.5) - spot.centre;
            light += value;
            spot.variance += value * from * from;
            spot.skew += value * from.x * from.x * from.x;
        }
    spot.variance /= light;
    spot.skew /= light;
    return spot;
}

constexpr uint32_t kSpotWidth = 96;
constexpr uint32_t kSpotHeight = 64;
const double kPixelsPerUnit = kSpotHeight / (2.0 * std::tan(kLensYFov / 2.0));

/// A white dot, 4 px wide from border to border of pixels, alone at a depth.
Spot drawSpot(
    gpu::Device& device,
    const CameraLens& lens,
    double depth,
    std::string_view method = "accumulate"
) {
    SceneBuilder scene;
    scene.setPerspective(kLensYFov);
    scene.world.registry.add(scene.camera, lens);
    const double pixel = 2.0 * std::tan(kLensYFov / 2.0) / kSpotHeight * depth;
    scene.add(
        test::makeQuad(4 * pixel, 4 * pixel, scene.addColor({1, 1, 1})),
        {.position = {0, 0, -depth}}
    );
    return measureSpot(test::renderOnce(
                           device,
                           scene,
                           {.method = method,
                            .width = kSpotWidth,
                            .height = kSpotHeight,
                            .exposureSeconds = 0.0,
                            .instants = 256,
                            .pixel = accumulate::PixelModel::Box,
                            .settings = {.sampleCount = 32}}
    ).color);
}

/// A disc of diameter D has the variance (D / 4)^2 along each axis.
math::dvec2 findDiameters(const Spot& spot, const Spot& sharp) {
    return 4.0 * glm::sqrt(glm::max(spot.variance - sharp.variance, math::dvec2(0.0)));
}

TEST_F(LensLaw, APointOfLightIsADiscOfTheThinLenssDiameter) {
    const Spot sharp = drawSpot(device(), {}, 3.0);
    for (const double depth : {1.5, 2.0, 3.0, 6.0, 30.0}) {
        CameraLens lens{.fStop = 0.05, .focusDistance = 3.0};
        for (const double squeeze : {1.0, 0.5}) {
            lens.squeeze = squeeze;
            const Spot spot = drawSpot(device(), lens, depth);
            const math::dvec2 diameters = findDiameters(spot, sharp);
            const double expected = scene::computeConfusionDiameter(
                lens, scene::computeLensRadius(lens, kLensYFov), depth, kPixelsPerUnit
            );
            EXPECT_NEAR(diameters.x, expected * squeeze, 0.5) << depth;
            EXPECT_NEAR(diameters.y, expected, 0.5) << depth;
            EXPECT_NEAR(spot.centre.x, kSpotWidth / 2.0, 0.1) << depth;
            EXPECT_NEAR(spot.centre.y, kSpotHeight / 2.0, 0.1) << depth;
        }
        lens.squeeze = 1.0;
        const double whole = findDiameters(drawSpot(device(), lens, depth), sharp).y;
        lens.fStop *= 2.0;
        if (depth == lens.focusDistance)
            continue; // half of nothing
        EXPECT_NEAR(findDiameters(drawSpot(device(), lens, depth), sharp).y, whole / 2.0, 0.5);
    }
}

TEST_F(LensLaw, TheOpeningIsInvertedInFrontOfTheFocus) {
    const CameraLens lens{
        .fStop = 0.0125, .focusDistance = 3.0, .blades = 3}; // a corner to the right
    // At both depths; E[x^3] of a triangle is a 40th of its circumradius's cube.
    const double radius =
        0.5 * scene::computeConfusionDiameter(
                  lens, scene::computeLensRadius(lens, kLensYFov), 6.0, kPixelsPerUnit
              );
    const double skew = std::pow(radius, 3.0) / 40.0;
    EXPECT_NEAR(drawSpot(device(), lens, 6.0).skew, skew, 0.05 * skew);
    EXPECT_NEAR(drawSpot(device(), lens, 2.0).skew, -skew, 0.05 * skew);
}

class LensTruthLaw : public test::RayTest {};

TEST_F(LensTruthLaw, RaysAndShearedPicturesSeeTheSameThroughTheLens) {
    const CameraLens disc{.fStop = 0.2, .focusDistance = 3.0};
    const CameraLens hexagon{
        .fStop = 0.3, .focusDistance = 1.5, .blades = 6, .bladeRotation = 0.3, .squeeze = 0.6};
    for (const auto& [lens, moves] : {std::pair{disc, false}, {disc, true}, {hexagon, true}}) {
        const SceneBuilder scene = makeRoom(lens, moves);
        Stage stage(device(), scene);
        for (const auto pixel : {accumulate::PixelModel::Centre, accumulate::PixelModel::Box}) {
            Shot shot{.width = 64, .height = 36, .instants = 256, .pixel = pixel};
            const image::Image sharp = stage.render(shot).color;
            shot.method = "truth";
            const image::Image rays = stage.render(shot).color;
            shot.method = "accumulate";
            const image::Image pictures = stage.render(shot).color;
            EXPECT_GE(image::computePsnr(rays, pictures), 50.0) << moves << int(pixel);
            EXPECT_LE(image::computePsnr(rays, sharp), 35.0) << "nothing is blurred";
        }
    }
}

TEST_F(LensTruthLaw, RaysFollowALensThatIsFocusedStoppedDownAndZoomed) {
    SceneBuilder scene = makeRoom({});
    scene.world.registry.add(
        scene.camera,
        scene::FocusMotion{
            {{-0.5, 1.5, 0.2, false}, {0.5, 6.0, 0.5, false}}, scene::PathInterpolation::Linear}
    );
    scene.world.registry.add(
        scene.camera, scene::LensMotion{{{-0.5, 0.8}, {0.5, 1.0}}, {}, scene::PathEase::None}
    );
    Stage stage(device(), scene);
    Shot shot{.width = 64, .height = 36, .instants = 256};
    shot.method = "truth";
    const image::Image rays = stage.render(shot).color;
    shot.method = "accumulate";
    EXPECT_GE(image::computePsnr(rays, stage.render(shot).color), 55.0);
}

TEST_F(LensTruthLaw, AdaptiveTracesThroughTheSamePlacesOfTheLensAsResolved) {
    const SceneBuilder scene = makeRoom({.fStop = 0.2, .focusDistance = 5.0}, true);
    Stage stage(device(), scene);
    Shot shot{
        .method = "truth", .width = 128, .height = 72, .exposureSeconds = 0.1, .instants = 256};
    const image::Image truth = stage.render(shot).color;
    shot.settings.sampleCount = 32;
    shot.method = "resolved";
    const double lookedUp = image::computePsnr(stage.render(shot).color, truth);
    shot.method = "adaptive";
    shot.settings.raysPerPixel = std::numeric_limits<float>::infinity();
    EXPECT_GE(image::computePsnr(stage.render(shot).color, truth), lookedUp + 1.0);
}

TEST_F(LensTruthLaw, DenoisedRaysAreTheTruthsWhereThereAreMany) {
    const SceneBuilder scene = makeRoom({.fStop = 0.2, .focusDistance = 3.0});
    Stage stage(device(), scene);
    Shot shot{.method = "denoised", .width = 64, .height = 36, .exposureSeconds = 0.0};
    shot.settings.sampleCount = 64;
    const image::Image denoised = stage.render(shot).color;
    shot.method = "truth";
    shot.instants = 256;
    EXPECT_GE(image::computePsnr(denoised, stage.render(shot).color), 52.0);
}

TEST_F(LensLaw, LensAndShutterTogetherAreTheMeanOverBoth) {
    SceneBuilder scene = makeRoom({.fStop = 0.2, .focusDistance = 5.0}, true);
    Stage stage(device(), scene);
    Shot shot{.method = "accumulate", .width = 64, .height = 36, .instants = 256};
    const image::Image joint = stage.render(shot).color;

    constexpr int kTimes = 32;
    image::Image mean;
    shot.instants = 64;
    shot.exposureSeconds = 0.0;
    for (int i = 0; i < kTimes; ++i) {
        shot.seconds = (i + 0.5) / kTimes - 0.5;
        const image::Image one = stage.render(shot).color;
        if (i == 0)
            mean = image::Image(one.width, one.height, one.channels);
        for (size_t k = 0; k < one.pixels.size(); ++k)
            mean.pixels[k] += one.pixels[k] / kTimes;
    }
    shot.seconds = 0.0;
    const image::Image lensOnly = stage.render(shot).color;
    scene.world.registry.remove<CameraLens>(scene.camera);
    shot.exposureSeconds = 1.0;
    const image::Image timeOnly = stage.render(shot).color;
    const double both = image::computePsnr(joint, mean);
    EXPECT_GE(both, 52.0);
    EXPECT_GE(both, image::computePsnr(lensOnly, mean) + 6.0);
    EXPECT_GE(both, image::computePsnr(timeOnly, mean) + 6.0);
}

TEST_F(LensLaw, ResolvedSpreadsAPointOfLightOverTheSameDisc) {
    const Spot sharp = drawSpot(device(), {}, 3.0, "resolved");
    const CameraLens lens{.fStop = 0.05, .focusDistance = 3.0};
    for (const double depth : {1.5, 2.0, 3.0, 6.0, 30.0}) {
        const Spot spot = drawSpot(device(), lens, depth, "resolved");
        // The filter over sets of places widens it a little.
        const math::dvec2 diameters = findDiameters(spot, sharp);
        const double expected = scene::computeConfusionDiameter(
            lens, scene::computeLensRadius(lens, kLensYFov), depth, kPixelsPerUnit
        );
        EXPECT_NEAR(diameters.x, expected, 0.7) << depth;
        EXPECT_NEAR(diameters.y, expected, 0.7) << depth;
        EXPECT_NEAR(spot.centre.x, kSpotWidth / 2.0, 0.1) << depth;
        EXPECT_NEAR(spot.centre.y, kSpotHeight / 2.0, 0.1) << depth;
    }
}

TEST_F(LensLaw, ResolvedLeavesWhatIsInFocusAndSurfacesOfOneColour) {
    SceneBuilder scene;
    scene.setPerspective(kLensYFov);
    scene.world.registry.add(scene.camera, CameraLens{.fStop = 0.5, .focusDistance = 5.0});
    scene.add(test::makeQuad(20, 14, scene.addWaves()), {.position = {0, 0, -5}});
    Stage stage(device(), scene);
    Shot shot{.width = 64, .height = 36, .exposureSeconds = 0.0};
    const image::Image sharp = stage.render(shot).color;
    shot.method = "resolved";
    EXPECT_TRUE(test::sameBits(stage.render(shot).color, sharp));

    SceneBuilder grey;
    grey.setPerspective(kLensYFov);
    grey.world.registry.add(grey.camera, CameraLens{.fStop = 0.1, .focusDistance = 3.0});
    for (const double z : {-1.0, -3.0, -9.0})
        grey.add(test::makeQuad(1, 1, grey.addColor({0.5f, 0.5f, 0.5f})), {.position = {0, 0, z}});
    shot.background = math::vec3(0.5f);
    const image::Image flat = test::renderOnce(device(), grey, shot).color;
    for (uint32_t y = 0; y < 36; ++y)
        for (uint32_t x = 0; x < 64; ++x)
            ASSERT_NEAR(flat.at(x, y, 1), 0.5f, 1e-3f) << x << " " << y;
}

TEST_F(LensLaw, ResolvedIsNearTheMeanOfManyPicturesWithAndWithoutMotion) {
    // In focus is the wall, or the box before it.
    for (const auto& [focus, exposure, least] :
         {std::tuple{5.0, 0.0, 41.0}, {5.0, 0.2, 36.0}, {2.0, 0.0, 37.5}, {2.0, 0.2, 35.0}}) {
        SceneBuilder scene = makeRoom({.fStop = 0.2, .focusDistance = focus}, true);
        Stage stage(device(), scene);
        Shot shot{
            .method = "accumulate",
            .width = 256,
            .height = 144,
            .exposureSeconds = exposure,
            .instants = 256};
        const image::Image many = stage.render(shot).color;
        shot.method = "resolved";
        shot.settings.sampleCount = 16;
        const double near = image::computePsnr(stage.render(shot).color, many);
        EXPECT_GE(near, least) << focus << " " << exposure;
        scene.world.registry.remove<CameraLens>(scene.camera);
        const double pinhole = image::computePsnr(stage.render(shot).color, many);
        if (focus == 5.0) {
            EXPECT_GE(near, pinhole + 2.0) << exposure;
        }
    }
}

TEST_F(LensLaw, FramesWhoseMeanIsThePictureTakeTurnsInThePlacesOfTheLens) {
    SceneBuilder scene;
    scene.setPerspective(kLensYFov);
    scene.world.registry.add(scene.camera, CameraLens{.fStop = 0.2, .focusDistance = 2.0});
    scene.add(test::makeQuad(6, 4, scene.addWaves()), {.position = {0, 0, -5}});
    Shot shot{
        .method = "accumulate",
        .width = 96,
        .height = 54,
        .exposureSeconds = 0.0,
        .instants = 1024,
        .pixel = accumulate::PixelModel::Box};
    const image::Image many = test::renderOnce(device(), scene, shot).color;
    shot.method = "resolved";
    shot.settings.sampleCount = 4;
    test::Frames frames(device(), scene);
    const auto draw = [&](game::AntiAliasing antiAliasing) {
        return frames.draw(shot, [&](game::PictureRequest& request) {
            request.antiAliasing = antiAliasing;
        });
    };
    const render::FrameResult mean = draw(game::AntiAliasing::Box);
    EXPECT_GE(image::computePsnr(mean.color, many), 41.5);
    EXPECT_FALSE(test::hasPass(mean, "filter lens"));
    EXPECT_TRUE(test::hasPass(draw(game::AntiAliasing::None), "filter lens"));
}

TEST_F(LensLaw, ResolvedHasTheSameBitsInEachRunAndOrderOfEntities) {
    std::vector<image::Image> pictures;
    for (const bool isReversed : {false, false, true}) {
        SceneBuilder scene;
        scene.setPerspective(kLensYFov);
        scene.world.registry.add(scene.camera, CameraLens{.fStop = 0.1, .focusDistance = 3.0});
        const auto grey = scene.addColor({0.6f, 0.5f, 0.4f});
        const auto waves = scene.addWaves();
        for (int i = 0; i < 6; ++i) {
            const int k = isReversed ? 5 - i : i;
            test::Placement at{.position = {0.4 * k - 1.0, 0.1 * k, -1.5 - 0.7 * k}};
            at.velocity = {0.2 * k, 0.0, 0.1};
            scene.add(test::makeQuad(0.7, 0.9, k % 2 == 0 ? grey : waves), at);
        }
        pictures.push_back(
            test::renderOnce(device(), scene, {.method = "resolved", .width = 80, .height = 50})
                .color
        );
    }
    EXPECT_TRUE(test::sameBits(pictures[1], pictures[0]));
    EXPECT_TRUE(test::sameBits(pictures[2], pictures[0]));
}

TEST_F(LensLaw, ResolvedStaysFiniteThroughAnyLens) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {41u, 39u}})
        for (const CameraLens& lens :
             {CameraLens{.fStop = 0.01, .focusDistance = 1.0},
              CameraLens{.fStop = 0.01, .focusDistance = 1.0e-4},
              CameraLens{.fStop = 0.01, .focusDistance = 1.0e9},
              CameraLens{.fStop = 1.0e9, .focusDistance = 1.0},
              CameraLens{.fStop = 0.1, .focusDistance = 1.0, .blades = 3, .squeeze = 4.0}}) {
            SceneBuilder scene = makeRoom(lens, true);
            // As near as the camera sees.
            scene.add(
                test::makeQuad(0.05, 0.05, scene.addColor({1, 1, 1})),
                {.position = {0.0, 0.0, -0.011}}
            );
            const image::Image seen =
                test::renderOnce(
                    device(), scene, {.method = "resolved", .width = width, .height = height}
                )
                    .color;
            for (const float value : seen.pixels)
                ASSERT_TRUE(std::isfinite(value) && value >= 0.0f)
                    << width << " " << lens.fStop << " " << lens.focusDistance;
        }
}

} // namespace
} // namespace shutter
