// SPDX-License-Identifier: MIT
// The lens, in the methods that have one: surfaces in focus stay sharp, light is spread over the
// image of the opening and not lost, edges have the closed form of a disc, and both truths see the
// same.
#include "assets/generator/demo_scenes.h"
#include "engine/image/metrics.h"
#include "engine/math/math.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/lens.h"
#include "game/options/shot_arguments.h"
#include "game/shot/picture_drawer.h"
#include "tests/image/laws.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using scene::CameraLens;
using test::AdaptiveLaw;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

constexpr double kView = 0.9; ///< radians, vertical
constexpr uint32_t kWide = 128;
constexpr uint32_t kHigh = 72;
const double kPxPerUnit = kHigh / (2.0 * std::tan(kView / 2.0));

class LensLaw : public test::GpuTest {};

/// Nothing before a camera with a lens.
SceneBuilder makeLensStage(const CameraLens& lens) {
    SceneBuilder scene = test::makeView(kView);
    scene.world.registry.add(scene.camera, lens);
    return scene;
}

/// A wall of waves at 5 m, a white box before it that tumbles, if anything moves.
SceneBuilder makeLensRoom(const CameraLens& lens, bool moves = false) {
    SceneBuilder scene = test::makeWavyRoom(5.0, 14.0, 9.0, kView);
    scene.world.registry.add(scene.camera, lens);
    test::Placement box{.position = {0.2, 0.1, -2}};
    if (moves) {
        box.velocity = {0.5, 0.2, 0.3};
        box.angularVelocity = {0.3, 2.0, 1.0};
    }
    test::addBox(scene, {0.6, 0.6, 0.6}, {0.9f, 0.8f, 0.7f}, box);
    return scene;
}

/// By 256 pairs, or by 32 samples of a method of the motion blur.
Shot makeLensShot(std::string_view method) {
    return {
        .method = method,
        .width = kWide,
        .height = kHigh,
        .exposureSeconds = 0.0,
        .instants = 256,
        .pixel = accumulate::PixelModel::Box,
        .settings = {.sampleCount = 32}};
}

/// In pixels of a picture of that height.
double computeConfusionRadius(const CameraLens& lens, double depth, uint32_t height = kHigh) {
    return 0.5 * scene::computeConfusionDiameter(
                     lens,
                     scene::computeLensRadius(lens, kView),
                     depth,
                     height / (2.0 * std::tan(kView / 2.0))
                 );
}

double sumGreen(const image::Image& picture) {
    return test::sumChannel(picture, 1);
}

TEST_F(LensLaw, ALensThatBlursNothingAndAMethodWithoutOneDrawThePinholeToTheBit) {
    const CameraLens open{.fStop = 0.5, .focusDistance = 5.0};
    const std::vector<CameraLens> closed{{.fStop = 0.0}, {.fStop = 0.5, .blurScale = 0.0}};
    std::vector<CameraLens> looked = closed;
    looked.push_back({.fStop = 8.0, .focusDistance = 3.0}); // leaves all in focus
    const std::tuple<std::string_view, bool, std::vector<CameraLens>> methods[] = {
        {"accumulate", true, closed},
        {"resolved", true, looked},
        {"truth", true, closed},
        {"denoised", true, closed},
        {"sharp", false, {open}},
        {"own_velocity", false, {open}},
        {"gather", false, {open}}};
    for (const bool moves : {false, true}) {
        SceneBuilder scene = makeLensRoom({}, moves);
        Stage stage(device(), scene);
        for (const auto& [method, hasLens, lenses] : methods) {
            if (!game::canRun(*game::findMethod(method).value(), device()))
                continue;
            const Shot shot{.method = method, .width = 48, .height = 32};
            scene.world.registry.remove<CameraLens>(scene.camera);
            const render::FrameResult pinhole = stage.render(shot);
            for (const CameraLens& lens : lenses) {
                scene.world.registry.add(scene.camera, lens);
                const render::FrameResult drawn = stage.render(shot);
                EXPECT_TRUE(test::sameBits(drawn.color, pinhole.color)) << method;
                EXPECT_EQ(drawn.statistics.passes.size(), pinhole.statistics.passes.size());
            }
            scene.world.registry.add(scene.camera, open);
            EXPECT_EQ(test::sameBits(stage.render(shot).color, pinhole.color), !hasLens) << method;
        }
    }
}

TEST_F(LensLaw, APlaneInFocusIsSharpAndSurfacesOfOneColourStayIt) {
    for (const auto& [method, mostInFocus, fStop, mostGrey] :
         {std::tuple{"accumulate", 4e-3, 0.5, 1e-4f}, {"resolved", 0.0, 0.1, 1e-3f}}) {
        Shot shot{.width = 64, .height = 36, .exposureSeconds = 0.0, .instants = 64};
        SceneBuilder scene = test::makeWavyRoom(5.0, 20.0, 14.0, kView);
        scene.world.registry.add(scene.camera, CameraLens{.fStop = 0.5, .focusDistance = 5.0});
        Stage stage(device(), scene);
        const image::Image sharp = stage.render(shot).color;
        shot.method = method;
        EXPECT_LE(image::computeMaxDifference(stage.render(shot).color, sharp), mostInFocus);
        SceneBuilder grey = makeLensStage({.fStop = fStop, .focusDistance = 3.0});
        const scene::AssetIndex color = grey.addColor({0.5f, 0.5f, 0.5f});
        for (const double z : {-1.0, -3.0, -9.0})
            grey.add(test::makeQuad(1, 1, color), {.position = {0, 0, z}});
        shot.background = math::vec3(0.5f);
        const image::Image flat = test::renderOnce(device(), grey, shot).color;
        for (uint32_t y = 0; y < 36; ++y)
            for (uint32_t x = 0; x < 64; ++x)
                ASSERT_NEAR(flat.at(x, y, 1), 0.5f, mostGrey) << method << x << " " << y;
    }
}

/// Of a picture's light.
struct Spot {
    math::dvec2 centre{0.0};
    math::dvec2 variance{0.0};
    double skew = 0.0; ///< third moment to the right
    double light = 0.0;
};

Spot measureSpot(const image::Image& picture) {
    Spot spot;
    spot.centre = test::computeCentroid(picture);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const double value = picture.at(x, y, 1);
            const math::dvec2 from = math::dvec2(x + 0.5, y + 0.5) - spot.centre;
            spot.light += value;
            spot.variance += value * from * from;
            spot.skew += value * from.x * from.x * from.x;
        }
    spot.variance /= spot.light;
    spot.skew /= spot.light;
    return spot;
}

constexpr uint32_t kSpotWide = 96;
constexpr uint32_t kSpotHigh = 64;

/// A white dot, 4 px wide from border to border of pixels, alone at a depth.
Spot drawSpot(
    const CameraLens& lens,
    double depth,
    std::string_view method = "accumulate",
    uint32_t width = kSpotWide,
    uint32_t height = kSpotHigh
) {
    SceneBuilder scene = makeLensStage(lens);
    const double side = 4.0 * 2.0 * std::tan(kView / 2.0) / height * depth;
    test::addCard(scene, {side, side}, {1, 1, 1}, {.position = {0, 0, -depth}});
    Shot shot = makeLensShot(method);
    shot.width = width;
    shot.height = height;
    return measureSpot(test::renderOnce(test::sharedDevice(), scene, shot).color);
}

/// A disc of diameter D has the variance (D / 4)^2 along each axis.
math::dvec2 findDiameters(const Spot& spot, const Spot& sharp) {
    return 4.0 * glm::sqrt(glm::max(spot.variance - sharp.variance, math::dvec2(0.0)));
}

TEST_F(LensLaw, APointOfLightIsADiscOfTheThinLenssDiameter) {
    // The filter of `resolved` over sets of places widens it a little.
    for (const auto& [method, mostPx] : {std::pair{"accumulate", 0.5}, {"resolved", 0.7}}) {
        SCOPED_TRACE(method);
        const Spot sharp = drawSpot({}, 3.0, method);
        for (const double depth : {1.5, 2.0, 3.0, 6.0, 30.0}) {
            CameraLens lens{.fStop = 0.05, .focusDistance = 3.0};
            const double expected = 2.0 * computeConfusionRadius(lens, depth, kSpotHigh);
            for (const double squeeze : {0.5, 1.0}) {
                if (squeeze < 1.0 && method == std::string_view("resolved"))
                    continue;
                lens.squeeze = squeeze;
                const Spot spot = drawSpot(lens, depth, method);
                const math::dvec2 diameters = findDiameters(spot, sharp);
                EXPECT_NEAR(diameters.x, expected * squeeze, mostPx) << depth;
                EXPECT_NEAR(diameters.y, expected, mostPx) << depth;
                EXPECT_NEAR(spot.centre.x, kSpotWide / 2.0, 0.1) << depth;
                EXPECT_NEAR(spot.centre.y, kSpotHigh / 2.0, 0.1) << depth;
                if (squeeze < 1.0 || depth == lens.focusDistance)
                    continue; // half of nothing
                lens.fStop *= 2.0;
                const Spot half = drawSpot(lens, depth, method);
                EXPECT_NEAR(findDiameters(half, sharp).y, diameters.y / 2.0, mostPx) << depth;
            }
        }
    }
}

TEST_F(LensLaw, ADiscInsideThePictureHasTheLightOfItsPoint) {
    for (const auto& [method, most] : {std::pair{"accumulate", 0.001}, {"resolved", 0.012}}) {
        const double sharp = drawSpot({}, 3.0, method, kWide, kHigh).light;
        for (const double depth : {1.5, 2.0, 6.0, 30.0}) {
            const CameraLens lens{.fStop = 0.05, .focusDistance = 3.0};
            const double light = drawSpot(lens, depth, method, kWide, kHigh).light;
            EXPECT_NEAR(light / sharp, 1.0, most) << method << " " << depth;
        }
    }
}

TEST_F(LensLaw, TheOpeningIsInvertedInFrontOfTheFocus) {
    const CameraLens lens{
        .fStop = 0.0125, .focusDistance = 3.0, .blades = 3}; // a corner to the right
    // At both depths; E[x^3] of a triangle is a 40th of its circumradius's cube.
    const double skew = std::pow(computeConfusionRadius(lens, 6.0, kSpotHigh), 3.0) / 40.0;
    EXPECT_NEAR(drawSpot(lens, 6.0).skew, skew, 0.05 * skew);
    EXPECT_NEAR(drawSpot(lens, 2.0).skew, -skew, 0.05 * skew);
}

TEST_F(LensLaw, RaysAndShearedPicturesSeeTheSameThroughTheLens) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "needs ray queries";
    const CameraLens disc{.fStop = 0.2, .focusDistance = 3.0};
    const CameraLens hexagon{
        .fStop = 0.3, .focusDistance = 1.5, .blades = 6, .bladeRotation = 0.3, .squeeze = 0.6};
    for (const auto& [lens, moves] : {std::pair{disc, false}, {disc, true}, {hexagon, true}}) {
        const SceneBuilder scene = makeLensRoom(lens, moves);
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

TEST_F(LensLaw, RaysFollowALensThatIsFocusedStoppedDownAndZoomed) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "needs ray queries";
    SceneBuilder scene = makeLensRoom({});
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

TEST_F(AdaptiveLaw, RaysPassTheSamePlacesOfTheLensAsLookupsOfResolved) {
    const SceneBuilder scene = makeLensRoom({.fStop = 0.2, .focusDistance = 5.0}, true);
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

TEST_F(AdaptiveLaw, RaysGoFirstToWhatALensSeesBeyondThePicturesBorder) {
    // Nothing but what lies beyond the border is not found.
    SceneBuilder scene = test::makeWavyRoom(5.0, 14.0, 9.0, kView);
    scene.world.registry.add(scene.camera, CameraLens{.fStop = 0.1, .focusDistance = 2.0});
    Stage stage(device(), scene);
    Shot shot = makeLensShot("accumulate");
    const image::Image many = stage.render(shot).color;
    shot.settings.sampleCount = 16;
    shot.method = "resolved";
    const double lookedUp = image::computePsnr(stage.render(shot).color, many);
    shot.method = "adaptive";
    shot.settings.raysPerPixel = 1.0f;
    EXPECT_GE(image::computePsnr(stage.render(shot).color, many), lookedUp + 3.0);
}

TEST_F(LensLaw, BeyondTheBorderAMovingCameraSeesWhatTheLastFrameShowed) {
    for (const double speed : {-30.0, 30.0}) {
        SceneBuilder scene = makeLensStage({.fStop = 0.1, .focusDistance = 2.5});
        scene.moveCamera({.velocity = {speed, 0, 0}});
        const scene::AssetIndex colors[] = {
            scene.addColor({0, 1, 0}), scene.addColor({1, 0.2f, 0})};
        for (int i = -20; i <= 20; ++i)
            scene.add(test::makeQuad(0.7, 9.0, colors[i & 1]), {.position = {0.7 * i, 0, -5}});
        Stage stage(device(), scene);
        Shot shot = makeLensShot("accumulate");
        shot.exposureSeconds = 1.0 / 60.0;
        shot.frameSeconds = 1.0 / 60.0;
        shot.phase = scene::ShutterPhase::End;
        const image::Image many = stage.render(shot).color;
        const auto measureError = [&](const image::Image& picture, uint32_t first) {
            double sum = 0.0;
            for (uint32_t y = 16; y + 16 < kHigh; ++y)
                for (uint32_t x = first; x < first + 8; ++x)
                    sum += std::abs(picture.at(x, y, 1) - many.at(x, y, 1));
            return sum / (8.0 * (kHigh - 32));
        };
        // adaptive searches in another order, and has too few rays here for the border.
        shot.settings.raysPerPixel = 0.01f;
        for (const char* method : {"resolved", "adaptive"}) {
            shot.method = method;
            if (shot.method == "adaptive" && !device().hasRayQuery())
                continue;
            const image::Image picture = stage.render(shot).color;
            const double middle = measureError(picture, kWide / 2);
            for (const uint32_t first : {0u, kWide - 8})
                EXPECT_LE(measureError(picture, first), 3.0 * middle)
                    << method << " " << speed << " " << first;
        }
    }
}

TEST_F(LensLaw, DenoisedRaysAreTheTruthsWhereThereAreMany) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "needs ray queries";
    const SceneBuilder scene = makeLensRoom({.fStop = 0.2, .focusDistance = 3.0});
    Stage stage(device(), scene);
    Shot shot{.method = "denoised", .width = 64, .height = 36, .exposureSeconds = 0.0};
    shot.settings.sampleCount = 64;
    const image::Image denoised = stage.render(shot).color;
    shot.method = "truth";
    shot.instants = 256;
    EXPECT_GE(image::computePsnr(denoised, stage.render(shot).color), 52.0);
}

TEST_F(LensLaw, LensAndShutterTogetherAreTheMeanOverBoth) {
    SceneBuilder scene = makeLensRoom({.fStop = 0.2, .focusDistance = 5.0}, true);
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

TEST_F(LensLaw, GlassIsSpreadByItsOwnDepthAndNotByThatOfWhatLiesBehindIt) {
    // In focus is the glass, then the wall. In the raster glass is spread as the wall is.
    for (const auto& [focus, least] : {std::pair{2.0, 30.5}, {5.0, 30.0}}) {
        SceneBuilder scene = test::makeWavyRoom(5.0, 14.0, 9.0, kView);
        scene.world.registry.add(scene.camera, CameraLens{.fStop = 0.15, .focusDistance = focus});
        for (int i = -2; i <= 2; ++i)
            scene.add(
                test::makeQuad(0.25, 1.2, test::addGlass(scene, {0.9f, 0.8f, 0.7f, 0.7f}, true)),
                {.position = {0.45 * i, 0.05 * i, -2}}
            );
        Stage stage(device(), scene);
        Shot shot = makeLensShot("accumulate");
        const image::Image many = stage.render(shot).color;
        shot.method = "resolved";
        EXPECT_GE(image::computePsnr(stage.render(shot).color, many), least) << focus;
    }
}

TEST_F(LensLaw, AnEdgeNearlyInFocusIsSeenInTheNextPixelToo) {
    // Between two colours of one plane, on a boundary of pixels: the mean distance along an axis of
    // a disc of radius 0.85 px is 0.36 px, and half of that lies on the other side.
    CameraLens lens{.fStop = 1.0, .focusDistance = 4.0};
    lens.fStop *= computeConfusionRadius(lens, 5.0) / 0.85;
    SceneBuilder scene = makeLensStage(lens);
    std::vector<scene::Primitive> halves;
    for (const float side : {-1.0f, 1.0f})
        halves.push_back(test::transformed(
            test::makeQuad(10.0, 10.0, scene.addColor(math::vec3(side < 0.0f ? 1.0f : 0.0f))),
            glm::translate(math::dmat4(1.0), math::dvec3(5.0 * side, 0, 0))
        ));
    scene.add(scene.addMesh(std::move(halves)), {.position = {0, 0, -5}});
    Stage stage(device(), scene);
    const auto measureLeak = [&](std::string_view method) {
        const image::Image picture = stage.render(makeLensShot(method)).color;
        double sum = 0.0;
        for (uint32_t y = 8; y < kHigh - 8; ++y)
            sum += picture.at(kWide / 2, y, 1);
        return sum / (kHigh - 16);
    };
    const double leak = measureLeak("accumulate");
    EXPECT_NEAR(leak, 0.18, 0.01);
    EXPECT_GE(measureLeak("resolved"), 0.6 * leak);
}

TEST_F(LensLaw, ResolvedIsNearTheMeanOfManyPicturesWithAndWithoutMotion) {
    // In focus is the wall, or the box before it.
    for (const auto& [focus, exposure, least] :
         {std::tuple{5.0, 0.0, 41.0}, {5.0, 0.2, 36.0}, {2.0, 0.0, 37.5}, {2.0, 0.2, 35.0}}) {
        SceneBuilder scene = makeLensRoom({.fStop = 0.2, .focusDistance = focus}, true);
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
    SceneBuilder scene = test::makeWavyRoom(5.0, 6.0, 4.0, kView);
    scene.world.registry.add(scene.camera, CameraLens{.fStop = 0.2, .focusDistance = 2.0});
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

TEST_F(LensLaw, PicturesHaveTheSameBitsInEachRunAndOrderOfEntities) {
    for (const std::string_view method : {"accumulate", "resolved"}) {
        std::vector<image::Image> pictures;
        for (const bool isReversed : {false, false, true}) {
            SceneBuilder scene = makeLensStage({.fStop = 0.1, .focusDistance = 3.0});
            const auto grey = scene.addColor({0.6f, 0.5f, 0.4f});
            const auto waves = scene.addWaves();
            for (int i = 0; i < 6; ++i) {
                const int k = isReversed ? 5 - i : i;
                scene.add(
                    test::makeQuad(0.7, 0.9, k % 2 == 0 ? grey : waves),
                    {.position = {0.4 * k - 1.0, 0.1 * k, -1.5 - 0.7 * k},
                     .velocity = {0.2 * k, 0.0, 0.1}}
                );
            }
            Shot shot{.method = method, .width = 80, .height = 50, .instants = 16};
            shot.pixel = accumulate::PixelModel::Box;
            pictures.push_back(test::renderOnce(device(), scene, shot).color);
        }
        EXPECT_TRUE(test::sameBits(pictures[1], pictures[0])) << method;
        EXPECT_TRUE(test::sameBits(pictures[2], pictures[0])) << method;
    }
}

TEST_F(LensLaw, ResolvedStaysFiniteThroughAnyLens) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {41u, 39u}})
        for (const CameraLens& lens :
             {CameraLens{.fStop = 0.01, .focusDistance = 1.0},
              CameraLens{.fStop = 0.01, .focusDistance = 1.0e-4},
              CameraLens{.fStop = 0.01, .focusDistance = 1.0e9},
              CameraLens{.fStop = 1.0e9, .focusDistance = 1.0},
              CameraLens{.fStop = 0.1, .focusDistance = 1.0, .blades = 3, .squeeze = 4.0}}) {
            SceneBuilder scene = makeLensRoom(lens, true);
            // As near as the camera sees.
            test::addCard(scene, {0.05, 0.05}, {1, 1, 1}, {.position = {0.0, 0.0, -0.011}});
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

/// The picture by `resolved`.
image::Image drawResolved(const SceneBuilder& scene) {
    return test::renderOnce(test::sharedDevice(), scene, makeLensShot("resolved")).color;
}

/// A white half plane, all left of the picture's middle, at a depth, before a dark blue wall.
SceneBuilder makeHalfPlane(const CameraLens& lens, double depth, double wall) {
    SceneBuilder scene = makeLensStage(lens);
    test::addCard(scene, {40, 40}, {0.1f, 0.2f, 0.4f}, {.position = {0, 0, -wall}});
    test::addCard(scene, {20, 20}, {0.9f, 0.8f, 0.6f}, {.position = {-10, 0, -depth}});
    return scene;
}

/// Share of a disc of radius 1 that lies left of x.
double discLeftOf(double x) {
    const double at = std::clamp(x, -1.0, 1.0);
    return 1.0 - (std::acos(at) - at * std::sqrt(1.0 - at * at)) / std::numbers::pi;
}

TEST_F(LensLaw, AnEdgeInFocusBeforeABlurredWallShowsNothingBeyondBothColours) {
    for (const std::string_view method : {"accumulate", "resolved"}) {
        const SceneBuilder scene = makeHalfPlane({.fStop = 0.1, .focusDistance = 2.0}, 2.0, 8.0);
        const image::Image seen = test::renderOnce(device(), scene, makeLensShot(method)).color;
        const float low[] = {0.1f, 0.2f, 0.4f};
        const float high[] = {0.9f, 0.8f, 0.6f};
        for (uint32_t y = 0; y < kHigh; ++y)
            for (uint32_t x = 0; x < kWide; ++x)
                for (uint32_t c = 0; c < 3; ++c) {
                    const float value = seen.at(x, y, c);
                    ASSERT_GE(value, low[c] - 1e-3f) << method << " " << x << " " << y;
                    ASSERT_LE(value, high[c] + 1e-3f) << method << " " << x << " " << y;
                    // The edge is in focus: it is where it was.
                    if (x + 1 < kWide / 2) {
                        ASSERT_NEAR(value, high[c], 4e-3f) << method << " " << x << " " << y;
                    } else if (x > kWide / 2) {
                        ASSERT_NEAR(value, low[c], 4e-3f) << method << " " << x << " " << y;
                    }
                }
    }
}

TEST_F(LensLaw, ANearEdgeBeforeASharpWallIsTheIntegralOfTheDisc) {
    const CameraLens lens{.fStop = 0.03, .focusDistance = 4.0};
    const double depth = 2.0;
    const double radius = computeConfusionRadius(lens, depth);
    ASSERT_GT(radius, 6.0);
    for (const auto& [method, most] :
         {std::pair<std::string_view, double>{"accumulate", 0.01}, {"resolved", 0.045}}) {
        const SceneBuilder scene = makeHalfPlane(lens, depth, 4.0);
        const image::Image seen = test::renderOnce(device(), scene, makeLensShot(method)).color;
        double worst = 0.0;
        for (uint32_t x = 0; x < kWide; ++x) {
            // The mean over the pixel, whose places are shifted by those of the lens.
            double expected = 0.0;
            constexpr int kPlaces = 16;
            for (int i = 0; i < kPlaces; ++i) {
                const double at = x + (i + 0.5) / kPlaces - kWide / 2.0;
                expected += (1.0 - discLeftOf(at / radius)) / kPlaces;
            }
            for (const uint32_t y : {kHigh / 3, kHigh / 2}) {
                const double share = (seen.at(x, y, 0) - 0.1) / 0.8;
                worst = std::max(worst, std::abs(share - expected));
            }
        }
        EXPECT_LE(worst, most) << method;
    }
}

TEST_F(LensLaw, AMirroredSceneIsTheMirroredPicture) {
    for (const auto& [method, least] :
         {std::pair<std::string_view, double>{"accumulate", 50.0}, {"resolved", 45.0}}) {
        const auto draw = [&, name = method](double side, uint32_t blades) {
            SceneBuilder scene = makeLensStage(
                {.fStop = 0.1, .focusDistance = 3.0, .blades = blades, .bladeRotation = 0.5}
            );
            if (side < 0.0 && blades > 0) {
                auto& lens = scene.world.registry.get<CameraLens>(scene.camera);
                lens.bladeRotation = std::numbers::pi - lens.bladeRotation;
            }
            for (const auto& [x, z, grey] :
                 {std::tuple{-0.5, -1.5, 0.9f},
                  {0.3, -2.0, 0.5f},
                  {0.6, -3.0, 0.7f},
                  {-0.9, -5.0, 0.3f}}) {
                const auto color = scene.addColor({grey, grey * 0.5f, 0.2f});
                scene.add(test::makeQuad(0.6, 0.9, color), {.position = {side * x, 0.1, z}});
            }
            Shot shot = makeLensShot(name);
            shot.background = {0.1f, 0.15f, 0.2f};
            return test::renderOnce(device(), scene, shot).color;
        };
        for (const uint32_t blades : {0u, 5u}) {
            const double near =
                image::computePsnr(test::mirror(draw(-1.0, blades)), draw(1.0, blades));
            EXPECT_GE(near, least) << method << " " << blades;
        }
    }
}

/// Adds a square that shines, from border to border of pixels if `centrePx` is a whole number.
/// \param centrePx from the picture's middle, right and up
void addLamp(
    SceneBuilder& scene,
    double sidePx,
    math::dvec2 centrePx,
    double depth,
    float radiance,
    double speedPx = 0.0
) {
    scene::Material lamp;
    lamp.baseColorFactor = {0, 0, 0, 1};
    lamp.emissive = math::vec3(radiance);
    const double metres = depth / kPxPerUnit; // of a pixel
    scene.add(
        test::makeQuad(sidePx * metres, sidePx * metres, scene.addMaterial(lamp)),
        {.position = {centrePx.x * metres, centrePx.y * metres, -depth},
         .velocity = {speedPx * metres, 0, 0}}
    );
}

constexpr CameraLens kWideOpen{.fStop = 0.05, .focusDistance = 3.0};

/// Greatest difference from an even disc of a light, away from its border, as a share of it.
double findUnevenness(
    const image::Image& seen, math::dvec2 centrePx, double radius, double light, double marginPx
) {
    const double inside = light / (std::numbers::pi * radius * radius);
    double worst = 0.0;
    for (uint32_t y = 0; y < kHigh; ++y)
        for (uint32_t x = 0; x < kWide; ++x) {
            const math::dvec2 from(
                x + 0.5 - kWide / 2.0 - centrePx.x, kHigh / 2.0 - y - 0.5 - centrePx.y
            );
            const double beyond = glm::length(from) - radius;
            if (std::abs(beyond) > marginPx)
                worst = std::max(
                    worst, std::abs(seen.at(x, y, 1) / inside - (beyond < 0.0 ? 1.0 : 0.0))
                );
        }
    return worst;
}

TEST_F(LensLaw, ABrightPointOutOfFocusIsAnEvenDiscOfItsLight) {
    constexpr float kRadiance = 40.0f;
    constexpr double kSidePx = 2.0;
    for (const double depth : {1.5, 2.0, 6.0, 30.0})
        for (const double shift : {0.0, 1.0}) { // across the corner of four squares, and in one
            SceneBuilder scene = makeLensStage(kWideOpen);
            addLamp(scene, kSidePx, {shift, shift}, depth, kRadiance);
            const image::Image seen = drawResolved(scene);
            const double light = kSidePx * kSidePx * kRadiance;
            const double radius = computeConfusionRadius(kWideOpen, depth);
            ASSERT_GT(radius, 3.0);
            const double uneven = findUnevenness(seen, {shift, shift}, radius, light, 1.8);
            EXPECT_NEAR(sumGreen(seen) / light, 1.0, 0.005) << depth << " " << shift;
            EXPECT_LE(uneven, 0.02) << depth << " " << shift;
        }
}

TEST_F(AdaptiveLaw, RaysDoNotAddTheLightOfABrightPointAgain) {
    Shot shot = makeLensShot("adaptive");
    shot.settings.sampleCount = 8;
    shot.settings.raysPerPixel = std::numeric_limits<float>::infinity();
    const double depth = 30.0;
    SceneBuilder scene = makeLensStage(kWideOpen);
    addLamp(scene, 2.0, {1.0, 1.0}, depth, 40.0f);
    const image::Image seen = test::renderOnce(device(), scene, shot).color;
    const double radius = computeConfusionRadius(kWideOpen, depth);
    EXPECT_NEAR(sumGreen(seen) / 160.0, 1.0, 0.005);
    EXPECT_LE(findUnevenness(seen, {1.0, 1.0}, radius, 160.0, 1.8), 0.02);
}

TEST_F(LensLaw, ABrightPointAtThePicturesBorderIsThePartOfItsDiscThatLiesInside) {
    const double depth = 30.0;
    const math::dvec2 corner(-(kWide / 2.0 - 1.0), kHigh / 2.0 - 1.0);
    for (const float radiance : {40.0f, 65000.0f}) { // as bright as a picture may be
        SceneBuilder scene = makeLensStage(kWideOpen);
        addLamp(scene, 2.0, corner, depth, radiance);
        const image::Image seen = drawResolved(scene);
        const double radius = computeConfusionRadius(kWideOpen, depth);
        EXPECT_LE(findUnevenness(seen, corner, radius, 4.0 * radiance, 1.8), 0.02) << radiance;
    }
}

TEST_F(LensLaw, ABrightPointIsTheImageOfTheOpeningAsOfManyPlaces) {
    CameraLens lens = kWideOpen;
    lens.blades = 3;
    lens.bladeRotation = 0.4;
    lens.squeeze = 0.7;
    for (const double roundness : {0.0, 0.3})
        for (const double depth : {1.5, 30.0}) {
            lens.roundness = roundness;
            SceneBuilder scene = makeLensStage(lens);
            addLamp(scene, 2.0, {1.0, 1.0}, depth, 40.0f);
            const image::Image seen = drawResolved(scene);
            Shot shot = makeLensShot("accumulate");
            shot.instants = 1024;
            const image::Image many = test::renderOnce(device(), scene, shot).color;
            float brightest = 0.0f;
            for (const float value : many.pixels)
                brightest = std::max(brightest, value);
            const double decibels = image::computePsnr(seen, many) + 20.0 * std::log10(brightest);
            EXPECT_NEAR(sumGreen(seen) / 160.0, 1.0, 0.015) << roundness << " " << depth;
            EXPECT_GE(decibels, 45.0) << roundness << " " << depth;
            const math::dvec2 apart = test::computeCentroid(seen) - test::computeCentroid(many);
            EXPECT_LE(glm::length(apart), 0.1) << roundness << " " << depth;
        }
}

TEST_F(LensLaw, ANearerEdgeInFocusHidesThePartOfABrightDiscThatItCovers) {
    const CameraLens lens{.fStop = 0.05, .focusDistance = 2.0};
    const double depth = 8.0;
    const math::dvec2 centre(2.0, 0.0);
    const auto draw = [&](bool isThere) {
        SceneBuilder scene = makeHalfPlane(lens, 2.0, 20.0);
        addLamp(scene, 2.0, centre, depth, isThere ? 40.0f : 0.0f);
        return drawResolved(scene);
    };
    const image::Image dark = draw(false);
    const image::Image lit = draw(true);
    const double radius = computeConfusionRadius(lens, depth);
    ASSERT_GT(radius, 4.0 + centre.x);
    const double inside = 160.0 / (std::numbers::pi * radius * radius);
    for (uint32_t y = 0; y < kHigh; ++y)
        for (uint32_t x = 0; x < kWide; ++x) {
            const math::dvec2 from(x + 0.5 - kWide / 2.0 - centre.x, kHigh / 2.0 - y - 0.5);
            const double added = lit.at(x, y, 1) - dark.at(x, y, 1);
            if (x + 1 < kWide / 2) {
                ASSERT_NEAR(added, 0.0, 4e-3) << x << " " << y;
            } else if (x > kWide / 2 && glm::length(from) < radius - 1.8) {
                ASSERT_NEAR(added, inside, 0.05 * inside) << x << " " << y;
            }
        }
}

TEST_F(LensLaw, AMovingBrightPointLeavesTheLightAndThePlaceOfManyPictures) {
    for (const auto& [speedPx, usesHistory] : // over the exposure
         {std::pair{2.0, false}, {30.0, false}, {2.0, true}, {30.0, true}}) {
        SceneBuilder scene = makeLensStage(kWideOpen);
        addLamp(scene, 2.0, {0.0, 0.0}, 30.0, 40.0f, speedPx / 0.2);
        const auto draw = [&, kept = usesHistory](std::string_view method) {
            Shot shot = makeLensShot(method);
            shot.exposureSeconds = 0.2;
            shot.settings.history = kept;
            return test::renderOnce(device(), scene, shot).color;
        };
        const image::Image seen = draw("resolved");
        const image::Image many = draw("accumulate");
        const math::dvec2 apart = test::computeCentroid(seen) - test::computeCentroid(many);
        // Samples at its border that see it in the last frame's raster do not add to the disc.
        EXPECT_NEAR(sumGreen(seen) / sumGreen(many), 1.0, 0.005) << speedPx << " " << usesHistory;
        EXPECT_LE(glm::length(apart), 0.1) << speedPx << " " << usesHistory;
    }
}

/// Else half-covered pixels at its border would give it the light of whole ones.
TEST_F(LensLaw, ABrightPointThatCoversPixelsInPartHasTheLightOfThatPart) {
    for (const double shiftPx : {0.0, 0.5}) {
        SceneBuilder scene = makeLensStage(kWideOpen);
        const double depth = 30.0;
        addLamp(scene, 2.0, {shiftPx, 0.0}, depth, 40.0f);
        // A moving camera's raster has several samples; the background does not move with the lamp.
        scene.moveCamera({.velocity = {2.0 / 0.2 * depth / kPxPerUnit, 0, 0}});
        Shot shot = makeLensShot("resolved");
        shot.exposureSeconds = 0.2;
        shot.phase = scene::ShutterPhase::End; // at which the raster is
        shot.settings.history = false;
        const image::Image seen = test::Frames(device(), scene)
                                      .draw(
                                          shot,
                                          [](game::PictureRequest& request) {
                                              request.antiAliasing = game::AntiAliasing::Taa;
                                          }
                                      )
                                      .color;
        EXPECT_NEAR(sumGreen(seen) / 160.0, 1.0, 0.01) << shiftPx;
    }
}

TEST_F(LensLaw, ABrightPointBehindANarrowOpeningStaysSamples) {
    CameraLens lens = kWideOpen;
    const double depth = 30.0;
    const auto draw = [&](double squeeze, float radiance) {
        lens.squeeze = squeeze;
        SceneBuilder scene = makeLensStage(lens);
        addLamp(scene, 2.0, {1.0, 1.0}, depth, radiance);
        return drawResolved(scene);
    };
    const double radius = computeConfusionRadius(lens, depth);
    for (const double squeeze : {0.2, 0.9}) {
        const bool isNarrow = radius * squeeze < 3.0;
        ASSERT_EQ(isNarrow, squeeze == 0.2) << radius;
        // Samples are in proportion to the light, of which points are what exceeds 1.
        const image::Image dim = draw(squeeze, 0.25f);
        const image::Image bright = draw(squeeze, 32.0f);
        double brightest = 0.0;
        double apart = 0.0;
        for (uint32_t y = 0; y < kHigh; ++y)
            for (uint32_t x = 0; x < kWide; ++x) {
                const double value = bright.at(x, y, 1);
                brightest = std::max(brightest, value);
                apart = std::max(apart, std::abs(value - 128.0 * dim.at(x, y, 1)));
            }
        if (isNarrow)
            EXPECT_LE(apart, 0.002 * brightest);
        else
            EXPECT_GE(apart, 0.2 * brightest);
    }
}

/// Else pixels would lie in hundreds of them.
TEST_F(LensLaw, OfARegionsBrightPointsOneAloneMakesALargeDisc) {
    const CameraLens lens{.fStop = 0.025, .focusDistance = 0.5};
    const double depth = 30.0;
    const double radius = computeConfusionRadius(lens, depth);
    ASSERT_GT(radius, 65.0);
    const auto findBrightest = [&](int count) {
        SceneBuilder scene = makeLensStage(lens);
        for (int i = 0; i < count; ++i) // within 32 x 32 pixels
            addLamp(scene, 2.0, {9.0 + 14.0 * i, -19.0}, depth, 40.0f);
        const image::Image seen = drawResolved(scene);
        double brightest = 0.0;
        for (uint32_t y = 0; y < kHigh; ++y)
            for (uint32_t x = 0; x < kWide; ++x)
                brightest = std::max(brightest, double(seen.at(x, y, 1)));
        return brightest;
    };
    const double even = 160.0 / (std::numbers::pi * radius * radius);
    EXPECT_NEAR(findBrightest(1), even, 0.02 * even);
    EXPECT_GT(findBrightest(2), 5.0 * even) << "the second one is some samples";
}

TEST_F(LensLaw, BrightPointsBeyondTheMaximumKeepTheirLightAndTheSameBitsInEachRun) {
    constexpr int kAcross = 4; // all within one region, of which eight are discs
    const auto draw = [&](int right, int down) {
        SceneBuilder scene = makeLensStage(kWideOpen);
        for (int i = 0; i < kAcross * kAcross; ++i)
            addLamp(
                scene,
                1.0,
                {right + 7.0 * (i % kAcross) + 1.5, 2.5 - down - 7.0 * (i / kAcross)},
                30.0,
                40.0f
            );
        return drawResolved(scene);
    };
    // The pixels of a block have other sets of places, which see a lamp more or less often.
    double sum = 0.0;
    for (int i = 0; i < 16; ++i)
        sum += sumGreen(draw(i % 4, i / 4));
    EXPECT_NEAR(sum / (16 * kAcross * kAcross * 40.0), 1.0, 0.005);
    EXPECT_TRUE(test::sameBits(draw(0, 0), draw(0, 0)));
}

TEST_F(LensLaw, WhatIsHiddenBehindACrowdAddsNoLight) {
    constexpr int kAcross = 8;        // more than a tile's list holds
    constexpr float kRadiance = 0.9f; // no bright points
    for (const double depth : {10.0, 15.0, 30.0}) {
        SceneBuilder scene = makeLensStage(kWideOpen);
        for (int i = 0; i < kAcross * kAcross; ++i)
            addLamp(
                scene,
                1.0,
                {5.0 * (i % kAcross) - 17.5, 5.0 * (i / kAcross) - 17.5},
                depth,
                kRadiance
            );
        const image::Image seen = drawResolved(scene);
        const double share = sumGreen(seen) / (kAcross * kAcross * double(kRadiance));
        EXPECT_NEAR(share, 1.0, 0.03) << depth;
    }
}

TEST_F(LensLaw, ABrightAreaIsNoPointSoThatAHundredTimesItsLightIsTheSamePicture) {
    const auto draw = [&](float radiance) {
        SceneBuilder scene = makeLensStage(kWideOpen);
        addLamp(scene, 14.0, {5.0, 3.0}, 30.0, radiance);
        return drawResolved(scene);
    };
    image::Image dim = draw(0.25f);
    for (float& value : dim.pixels)
        value *= 128.0f;
    image::Image bright = draw(32.0f);
    for (size_t i = 3; i < bright.pixels.size(); i += 4)
        dim.pixels[i] = bright.pixels[i]; // alpha
    EXPECT_TRUE(test::sameBits(bright, dim));
}

TEST_F(LensLaw, AFloorCloseBelowTheLensIsSpreadByTheDepthOfEachPlaceOnIt) {
    // Near the camera, circles of confusion grow by a tenth of a pixel and more per pixel. One
    // depth for each block's places of the lens has 38.1 dB.
    SceneBuilder scene = makeLensStage({.fStop = 0.05, .focusDistance = 6.0});
    scene.add(
        test::makeQuad(12, 12, scene.addWaves()),
        {.position = {0, -0.3, -2}, .rotation = glm::angleAxis(-1.45, math::dvec3(1, 0, 0))}
    );
    test::Stage stage(device(), scene);
    Shot shot = makeLensShot("accumulate");
    shot.background = {0.1f, 0.15f, 0.2f};
    const image::Image many = stage.render(shot).color;
    shot.method = "resolved";
    const double near = image::computePsnr(stage.render(shot).color, many);
    EXPECT_GE(near, 39.5);
}

/// A film in which the focus is pulled, as a flight of the project draws it.
class FocusPull {
  public:
    FocusPull() {
        const test::TempFolder folder;
        game::ShotArguments arguments;
        arguments.scene = (folder.path() / "gallery.glb").string();
        EXPECT_EQ(generator::buildGalleryScene().write(arguments.scene), "");
        arguments.flythrough =
            std::string(SHUTTER_SOURCE_DIR) + "/assets/flythroughs/gallery_focus.json";
        arguments.size = {160, 90};
        options = game::interpret(arguments).value();
        options.usesLens = true;
        const core::Status loaded = game::loadFlythrough(arguments, options);
        EXPECT_TRUE(loaded.ok()) << loaded.error().message;
        shot.emplace(game::loadShot(options).value());
        renderer.emplace(test::sharedDevice(), shot->world.assets);
        drawer.emplace(test::sharedDevice(), *renderer);
    }

    /// \param isSmooth over the whole pixel
    image::Image
    draw(game::PictureDrawer& by, std::string_view method, size_t frame, bool isSmooth = true) {
        game::MethodOptions chosen = game::makeMethod(*game::findMethod(method).value());
        game::ShotOptions smooth = options;
        if (method == "accumulate") {
            chosen.samples = 256;
            smooth.pixel = extract::PixelModel::Box;
        } else if (isSmooth)
            smooth.picture.antiAliasing = game::AntiAliasing::Box;
        const game::PictureRequest picture =
            game::makePicture(*shot, smooth, chosen, options.frameTimes.at(frame));
        auto drawn = by.draw(shot->world, picture);
        EXPECT_TRUE(drawn.ok());
        return std::move(drawn).value().color;
    }

    game::ShotOptions options;
    std::optional<game::Shot> shot;
    std::optional<render::Renderer> renderer;
    std::optional<game::PictureDrawer> drawer;
};

TEST_F(LensLaw, EveryFrameOfAFocusPullByResolvedIsNearTheMeanOfManyPictures) {
    FocusPull film;
    // In focus is the near target, what lies between, the wall; then the lens is stopped down.
    double nearest = 1e9;
    double farthest = 0.0;
    for (size_t frame = 6; frame < film.options.frameTimes.size(); frame += 11) {
        const double focus =
            scene::lensAt(film.shot->world, film.shot->camera, film.options.frameTimes[frame])
                .focusDistance;
        nearest = std::min(nearest, focus);
        farthest = std::max(farthest, focus);
        const image::Image mean = film.draw(*film.drawer, "accumulate", frame);
        const double resolved =
            image::computePsnr(film.draw(*film.drawer, "resolved", frame), mean);
        const double sharp = image::computePsnr(film.draw(*film.drawer, "sharp", frame), mean);
        EXPECT_GE(resolved, 37.0) << frame;
        EXPECT_GE(resolved, sharp + 10.0) << frame;
    }
    EXPECT_LT(nearest, 1.5);
    EXPECT_GT(farthest, 6.0);
}

TEST_F(LensLaw, AFrameOfAFocusPullIsTheSameWhicheverWereDrawnBefore) {
    FocusPull film;
    std::vector<image::Image> inOrder;
    for (size_t frame = 24; frame < 28; ++frame)
        inOrder.push_back(film.draw(*film.drawer, "resolved", frame, false));
    for (const size_t frame : {27, 25}) {
        game::PictureDrawer alone(device(), *film.renderer);
        EXPECT_TRUE(test::sameBits(film.draw(alone, "resolved", frame, false), inOrder[frame - 24]))
            << frame;
    }
}

} // namespace
} // namespace shutter
