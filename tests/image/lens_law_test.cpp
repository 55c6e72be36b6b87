// SPDX-License-Identifier: MIT
// Laws of depth of field: light is spread and not lost, edges have the closed form of a disc, and
// nothing depends on which side is which.
#include "engine/image/metrics.h"
#include "engine/math/math.h"
#include "engine/scene/lens.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using scene::CameraLens;
using test::SceneBuilder;
using test::Shot;

constexpr double kView = 0.9; ///< radians, vertical
constexpr uint32_t kWide = 128;
constexpr uint32_t kHigh = 72;
const double kPxPerUnit = kHigh / (2.0 * std::tan(kView / 2.0));

class LensLight : public test::GpuTest {};

SceneBuilder makeStage(const CameraLens& lens) {
    SceneBuilder scene;
    scene.setPerspective(kView);
    scene.world.registry.add(scene.camera, lens);
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

double sumLight(const image::Image& picture) {
    double sum = 0.0;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x)
            sum += picture.at(x, y, 1);
    return sum;
}

/// A white half plane, all left of the picture's middle, at a depth, before a dark blue wall.
SceneBuilder makeHalfPlane(const CameraLens& lens, double depth, double wall) {
    SceneBuilder scene = makeStage(lens);
    scene.add(
        test::makeQuad(40, 40, scene.addColor({0.1f, 0.2f, 0.4f})), {.position = {0, 0, -wall}}
    );
    scene.add(
        test::makeQuad(20, 20, scene.addColor({0.9f, 0.8f, 0.6f})), {.position = {-10, 0, -depth}}
    );
    return scene;
}

/// Share of a disc of radius 1 that lies left of x.
double discLeftOf(double x) {
    const double at = std::clamp(x, -1.0, 1.0);
    return 1.0 - (std::acos(at) - at * std::sqrt(1.0 - at * at)) / std::numbers::pi;
}

TEST_F(LensLight, ADiscInsideThePictureHasTheLightOfItsPoint) {
    for (const auto& [method, most] :
         {std::pair<std::string_view, double>{"accumulate", 0.001}, {"resolved", 0.012}})
        for (const double depth : {1.5, 2.0, 6.0, 30.0}) {
            const double side = 4.0 / kPxPerUnit * depth; // from border to border of pixels
            const auto light = [&, name = method](const CameraLens& lens) {
                SceneBuilder scene = makeStage(lens);
                scene.add(
                    test::makeQuad(side, side, scene.addColor({1, 1, 1})),
                    {.position = {0, 0, -depth}}
                );
                return sumLight(test::renderOnce(device(), scene, makeLensShot(name)).color);
            };
            const double share = light({.fStop = 0.05, .focusDistance = 3.0}) / light({});
            RecordProperty(fmt::format("{}_{}", method, depth), fmt::format("{:.4f}", share));
            EXPECT_NEAR(share, 1.0, most) << method << " " << depth;
        }
}

TEST_F(LensLight, AnEdgeInFocusBeforeABlurredWallShowsNothingBeyondBothColours) {
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

TEST_F(LensLight, ANearEdgeBeforeASharpWallIsTheIntegralOfTheDisc) {
    const CameraLens lens{.fStop = 0.03, .focusDistance = 4.0};
    const double depth = 2.0;
    const double radius = 0.5 * scene::computeConfusionDiameter(
                                    lens, scene::computeLensRadius(lens, kView), depth, kPxPerUnit
                                );
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
        RecordProperty(std::string(method), fmt::format("{:.4f}", worst));
        EXPECT_LE(worst, most) << method;
    }
}

TEST_F(LensLight, AMirroredSceneIsTheMirroredPicture) {
    for (const auto& [method, least] :
         {std::pair<std::string_view, double>{"accumulate", 50.0}, {"resolved", 45.0}}) {
        const auto draw = [&, name = method](double side, uint32_t blades) {
            SceneBuilder scene = makeStage(
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
            RecordProperty(fmt::format("{}_{}", method, blades), fmt::format("{:.1f}", near));
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

double computeConfusionRadius(const CameraLens& lens, double depth) {
    return 0.5 * scene::computeConfusionDiameter(
                     lens, scene::computeLensRadius(lens, kView), depth, kPxPerUnit
                 );
}

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

TEST_F(LensLight, ABrightPointOutOfFocusIsAnEvenDiscOfItsLight) {
    constexpr float kRadiance = 40.0f;
    constexpr double kSidePx = 2.0;
    for (const double depth : {1.5, 2.0, 6.0, 30.0})
        for (const double shift : {0.0, 1.0}) { // across the corner of four squares, and in one
            SceneBuilder scene = makeStage(kWideOpen);
            addLamp(scene, kSidePx, {shift, shift}, depth, kRadiance);
            const image::Image seen =
                test::renderOnce(device(), scene, makeLensShot("resolved")).color;
            const double light = kSidePx * kSidePx * kRadiance;
            const double radius = computeConfusionRadius(kWideOpen, depth);
            ASSERT_GT(radius, 3.0);
            const double uneven = findUnevenness(seen, {shift, shift}, radius, light, 1.8);
            RecordProperty(
                fmt::format("{}_{}", depth, shift),
                fmt::format("{:.4f} {:.4f}", sumLight(seen) / light, uneven)
            );
            EXPECT_NEAR(sumLight(seen) / light, 1.0, 0.005) << depth << " " << shift;
            EXPECT_LE(uneven, 0.02) << depth << " " << shift;
        }
}

TEST_F(LensLight, RaysOfAdaptiveDoNotAddTheLightOfABrightPointAgain) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "adaptive needs ray queries";
    Shot shot = makeLensShot("adaptive");
    shot.settings.sampleCount = 8;
    shot.settings.raysPerPixel = std::numeric_limits<float>::infinity();
    const double depth = 30.0;
    SceneBuilder scene = makeStage(kWideOpen);
    addLamp(scene, 2.0, {1.0, 1.0}, depth, 40.0f);
    const image::Image seen = test::renderOnce(device(), scene, shot).color;
    const double radius = computeConfusionRadius(kWideOpen, depth);
    EXPECT_NEAR(sumLight(seen) / 160.0, 1.0, 0.005);
    EXPECT_LE(findUnevenness(seen, {1.0, 1.0}, radius, 160.0, 1.8), 0.02);
}

TEST_F(LensLight, ABrightPointAtThePicturesBorderIsThePartOfItsDiscThatLiesInside) {
    const double depth = 30.0;
    const math::dvec2 corner(-(kWide / 2.0 - 1.0), kHigh / 2.0 - 1.0);
    for (const float radiance : {40.0f, 65000.0f}) { // as bright as a picture may be
        SceneBuilder scene = makeStage(kWideOpen);
        addLamp(scene, 2.0, corner, depth, radiance);
        const image::Image seen = test::renderOnce(device(), scene, makeLensShot("resolved")).color;
        const double radius = computeConfusionRadius(kWideOpen, depth);
        EXPECT_LE(findUnevenness(seen, corner, radius, 4.0 * radiance, 1.8), 0.02) << radiance;
    }
}

TEST_F(LensLight, ABrightPointIsTheImageOfTheOpeningAsOfManyPlaces) {
    CameraLens lens = kWideOpen;
    lens.blades = 3;
    lens.bladeRotation = 0.4;
    lens.squeeze = 0.7;
    for (const double roundness : {0.0, 0.3})
        for (const double depth : {1.5, 30.0}) {
            lens.roundness = roundness;
            SceneBuilder scene = makeStage(lens);
            addLamp(scene, 2.0, {1.0, 1.0}, depth, 40.0f);
            const image::Image seen =
                test::renderOnce(device(), scene, makeLensShot("resolved")).color;
            Shot shot = makeLensShot("accumulate");
            shot.instants = 1024;
            const image::Image many = test::renderOnce(device(), scene, shot).color;
            float brightest = 0.0f;
            for (const float value : many.pixels)
                brightest = std::max(brightest, value);
            const double decibels = image::computePsnr(seen, many) + 20.0 * std::log10(brightest);
            RecordProperty(
                fmt::format("{}_{}", roundness, depth),
                fmt::format("{:.1f} {:.4f}", decibels, sumLight(seen) / 160.0)
            );
            EXPECT_NEAR(sumLight(seen) / 160.0, 1.0, 0.015) << roundness << " " << depth;
            EXPECT_GE(decibels, 45.0) << roundness << " " << depth;
            const math::dvec2 apart = test::computeCentroid(seen) - test::computeCentroid(many);
            EXPECT_LE(glm::length(apart), 0.1) << roundness << " " << depth;
        }
}

TEST_F(LensLight, ANearerEdgeInFocusHidesThePartOfABrightDiscThatItCovers) {
    const CameraLens lens{.fStop = 0.05, .focusDistance = 2.0};
    const double depth = 8.0;
    const math::dvec2 centre(2.0, 0.0);
    const auto draw = [&](bool isThere) {
        SceneBuilder scene = makeHalfPlane(lens, 2.0, 20.0);
        addLamp(scene, 2.0, centre, depth, isThere ? 40.0f : 0.0f);
        return test::renderOnce(device(), scene, makeLensShot("resolved")).color;
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

TEST_F(LensLight, AMovingBrightPointLeavesTheLightAndThePlaceOfManyPictures) {
    for (const auto& [speedPx, usesHistory] : // over the exposure
         {std::pair{2.0, false}, {30.0, false}, {2.0, true}, {30.0, true}}) {
        SceneBuilder scene = makeStage(kWideOpen);
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
        RecordProperty(
            fmt::format("{}_{}", speedPx, usesHistory),
            fmt::format(
                "{:.4f} {:.3f} {:.1f}",
                sumLight(seen) / sumLight(many),
                glm::length(apart),
                image::computePsnr(seen, many)
            )
        );
        // Samples at its border that see it in the last frame's raster do not add to the disc.
        EXPECT_NEAR(sumLight(seen) / sumLight(many), 1.0, 0.005) << speedPx << " " << usesHistory;
        EXPECT_LE(glm::length(apart), 0.1) << speedPx << " " << usesHistory;
    }
}

/// Else half-covered pixels at its border would give it the light of whole ones.
TEST_F(LensLight, ABrightPointThatCoversPixelsInPartHasTheLightOfThatPart) {
    for (const double shiftPx : {0.0, 0.5}) {
        SceneBuilder scene = makeStage(kWideOpen);
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
        RecordProperty(fmt::format("{}", shiftPx), fmt::format("{:.4f}", sumLight(seen) / 160.0));
        EXPECT_NEAR(sumLight(seen) / 160.0, 1.0, 0.01) << shiftPx;
    }
}

TEST_F(LensLight, ABrightPointBehindANarrowOpeningStaysSamples) {
    CameraLens lens = kWideOpen;
    const double depth = 30.0;
    const auto draw = [&](double squeeze, float radiance) {
        lens.squeeze = squeeze;
        SceneBuilder scene = makeStage(lens);
        addLamp(scene, 2.0, {1.0, 1.0}, depth, radiance);
        return test::renderOnce(device(), scene, makeLensShot("resolved")).color;
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
TEST_F(LensLight, OfARegionsBrightPointsOneAloneMakesALargeDisc) {
    const CameraLens lens{.fStop = 0.025, .focusDistance = 0.5};
    const double depth = 30.0;
    const double radius = computeConfusionRadius(lens, depth);
    ASSERT_GT(radius, 65.0);
    const auto findBrightest = [&](int count) {
        SceneBuilder scene = makeStage(lens);
        for (int i = 0; i < count; ++i) // within 32 x 32 pixels
            addLamp(scene, 2.0, {9.0 + 14.0 * i, -19.0}, depth, 40.0f);
        const image::Image seen = test::renderOnce(device(), scene, makeLensShot("resolved")).color;
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

TEST_F(LensLight, BrightPointsBeyondTheMaximumKeepTheirLightAndTheSameBitsInEachRun) {
    constexpr int kAcross = 4; // all within one region, of which eight are discs
    const auto draw = [&](int right, int down) {
        SceneBuilder scene = makeStage(kWideOpen);
        for (int i = 0; i < kAcross * kAcross; ++i)
            addLamp(
                scene,
                1.0,
                {right + 7.0 * (i % kAcross) + 1.5, 2.5 - down - 7.0 * (i / kAcross)},
                30.0,
                40.0f
            );
        return test::renderOnce(device(), scene, makeLensShot("resolved")).color;
    };
    // The pixels of a block have other sets of places, which see a lamp more or less often.
    double sum = 0.0;
    for (int i = 0; i < 16; ++i)
        sum += sumLight(draw(i % 4, i / 4));
    EXPECT_NEAR(sum / (16 * kAcross * kAcross * 40.0), 1.0, 0.005);
    EXPECT_TRUE(test::sameBits(draw(0, 0), draw(0, 0)));
}

TEST_F(LensLight, WhatIsHiddenBehindACrowdAddsNoLight) {
    constexpr int kAcross = 8;        // more than a tile's list holds
    constexpr float kRadiance = 0.9f; // no bright points
    for (const double depth : {10.0, 15.0, 30.0}) {
        SceneBuilder scene = makeStage(kWideOpen);
        for (int i = 0; i < kAcross * kAcross; ++i)
            addLamp(
                scene,
                1.0,
                {5.0 * (i % kAcross) - 17.5, 5.0 * (i / kAcross) - 17.5},
                depth,
                kRadiance
            );
        const image::Image seen = test::renderOnce(device(), scene, makeLensShot("resolved")).color;
        const double share = sumLight(seen) / (kAcross * kAcross * double(kRadiance));
        RecordProperty(fmt::format("{}", depth), fmt::format("{:.4f}", share));
        EXPECT_NEAR(share, 1.0, 0.03) << depth;
    }
}

TEST_F(LensLight, ABrightAreaIsNoPointSoThatAHundredTimesItsLightIsTheSamePicture) {
    const auto draw = [&](float radiance) {
        SceneBuilder scene = makeStage(kWideOpen);
        addLamp(scene, 14.0, {5.0, 3.0}, 30.0, radiance);
        return test::renderOnce(device(), scene, makeLensShot("resolved")).color;
    };
    image::Image dim = draw(0.25f);
    for (float& value : dim.pixels)
        value *= 128.0f;
    image::Image bright = draw(32.0f);
    for (size_t i = 3; i < bright.pixels.size(); i += 4)
        dim.pixels[i] = bright.pixels[i]; // alpha
    EXPECT_TRUE(test::sameBits(bright, dim));
}

TEST_F(LensLight, TwiceTheFNumberHalvesTheDiscInResolvedToo) {
    const auto spread = [&](double fStop, double depth) {
        const double side = 4.0 / kPxPerUnit * depth;
        SceneBuilder scene = makeStage({.fStop = fStop, .focusDistance = 3.0});
        scene.add(
            test::makeQuad(side, side, scene.addColor({1, 1, 1})), {.position = {0, 0, -depth}}
        );
        const image::Image seen = test::renderOnce(device(), scene, makeLensShot("resolved")).color;
        const math::dvec2 centre = test::computeCentroid(seen);
        double variance = 0.0;
        for (uint32_t y = 0; y < kHigh; ++y)
            for (uint32_t x = 0; x < kWide; ++x)
                variance += seen.at(x, y, 1) * std::pow(y + 0.5 - centre.y, 2.0);
        return variance / sumLight(seen);
    };
    for (const double depth : {1.5, 6.0, 30.0}) {
        const double sharp = spread(0.0, depth);
        const auto diameter = [&](double fStop) {
            return 4.0 * std::sqrt(std::max(spread(fStop, depth) - sharp, 0.0));
        };
        EXPECT_NEAR(diameter(0.1), diameter(0.05) / 2.0, 0.7) << depth;
    }
}

TEST_F(LensLight, AFloorCloseBelowTheLensIsSpreadByTheDepthOfEachPlaceOnIt) {
    // Near the camera, circles of confusion grow by a tenth of a pixel and more per pixel. One
    // depth for each block's places of the lens has 38.1 dB.
    SceneBuilder scene = makeStage({.fStop = 0.05, .focusDistance = 6.0});
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
    RecordProperty("psnr", fmt::format("{:.2f}", near));
    EXPECT_GE(near, 39.5);
}

TEST_F(LensLight, AccumulateHasTheSameBitsInEachRunAndOrderOfEntities) {
    std::vector<image::Image> pictures;
    for (const bool isReversed : {false, false, true}) {
        SceneBuilder scene = makeStage({.fStop = 0.1, .focusDistance = 3.0});
        const auto waves = scene.addWaves();
        for (int i = 0; i < 5; ++i) {
            const int k = isReversed ? 4 - i : i;
            scene.add(
                test::makeQuad(0.7, 0.9, waves),
                {.position = {0.4 * k - 0.8, 0.1 * k, -1.5 - 0.7 * k}, .velocity = {0.2 * k, 0, 0}}
            );
        }
        Shot shot = makeLensShot("accumulate");
        shot.exposureSeconds = 0.2;
        shot.instants = 16;
        pictures.push_back(test::renderOnce(device(), scene, shot).color);
    }
    EXPECT_TRUE(test::sameBits(pictures[1], pictures[0]));
    EXPECT_TRUE(test::sameBits(pictures[2], pictures[0]));
}

} // namespace
} // namespace shutter
