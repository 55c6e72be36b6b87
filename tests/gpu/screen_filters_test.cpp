// SPDX-License-Identifier: MIT
// The filters of one layer on the device: in a centred exposure each is its publication's, written
// down once more here in half velocities; and no input makes a value that is not finite.
#include "engine/image/image.h"
#include "modules/motion_blur/motion_blur.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace shutter {
namespace {

using glm::dvec2;
using glm::dvec3;
using image::Image;
using motion_blur::getMethod;
using motion_blur::Method;
using motion_blur::MotionBlurSettings;

class ScreenFilters : public test::GpuTest {};

constexpr uint32_t kWidth = 48;
constexpr uint32_t kHeight = 32;
constexpr double kSoftExtent = 0.03;
/// The longest motion; taps along it stay off the borders between texels.
const dvec2 kDominant(11.3, 4.7);

struct Scene {
    Image color{kWidth, kHeight, 4};
    Image motionDepth{kWidth, kHeight, 4};
};

/// Random colours that half floats hold; motions shorter than the dominant one, a third of them
/// none, at two depths.
Scene makeScene() {
    Scene scene;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            for (uint32_t c = 0; c < 3; ++c)
                scene.color.at(x, y, c) = image::roundToHalf(unit(random));
            scene.color.at(x, y, 3) = 1.0f;
            const bool still = random() % 3 == 0;
            for (uint32_t c = 0; c < 2; ++c)
                scene.motionDepth.at(x, y, c) = still ? 0.0f : 16.0f * unit(random) - 8.0f;
            scene.motionDepth.at(x, y, 2) = random() % 2 == 0 ? 3.0f : 3.02f;
        }
    scene.motionDepth.at(20, 13, 0) = float(kDominant.x);
    scene.motionDepth.at(20, 13, 1) = float(kDominant.y);
    return scene;
}

Image blur(
    gpu::Device& device, const Scene& scene, MotionBlurSettings settings, double rasterTime = 0.5
) {
    test::GraphRig rig(device);
    motion_blur::MotionBlur effect(device, VK_NULL_HANDLE);
    motion_blur::MotionBlurInputs inputs;
    inputs.color = rig.uploadColor(scene.color);
    inputs.motionDepth = rig.upload(scene.motionDepth);
    inputs.rasterTime = rasterTime;
    const size_t ticket = rig.want(effect.add(rig.graph, inputs, settings).color);
    run(rig);
    return rig.take(ticket);
}

/// One tile holds the whole picture; no noise.
MotionBlurSettings oneTile(const Method* method) {
    MotionBlurSettings settings;
    settings.method = method;
    settings.tileSizePx = 64;
    settings.softDepthExtent = float(kSoftExtent);
    settings.softDepthShare = 0.0f;
    settings.jitter = 0.0f;
    return settings;
}

/// What a publication's pseudocode reads at a place: clamped to the picture.
struct Texel {
    dvec3 color;
    dvec2 half; ///< half velocity
    double depth;
};

Texel read(const Scene& scene, const dvec2& at) {
    const auto x = uint32_t(std::clamp(std::floor(at.x), 0.0, double(kWidth - 1)));
    const auto y = uint32_t(std::clamp(std::floor(at.y), 0.0, double(kHeight - 1)));
    const auto value = [&](const Image& image, uint32_t c) { return double(image.at(x, y, c)); };
    return {
        {value(scene.color, 0), value(scene.color, 1), value(scene.color, 2)},
        0.5 * dvec2(value(scene.motionDepth, 0), value(scene.motionDepth, 1)),
        value(scene.motionDepth, 2)};
}

double clamp01(double x) {
    return std::clamp(x, 0.0, 1.0);
}

double cone(double distance, double reach) {
    return reach > 0.0 ? clamp01(1.0 - distance / reach) : (distance > 0.0 ? 0.0 : 1.0);
}

double cylinder(double distance, double reach) {
    if (reach <= 0.0)
        return distance > 0.0 ? 0.0 : 1.0;
    const double t = clamp01((distance - 0.95 * reach) / (0.1 * reach));
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

/// 1 where `a` is no deeper than `b`, 0 where it is by the whole extent.
double isInFront(double a, double b) {
    return clamp01(1.0 - (a - b) / kSoftExtent);
}

/// McGuire 2012, the pseudocode of the reconstruction.
dvec3 filterMcGuire(const Scene& scene, const dvec2& centre) {
    constexpr int kTaps = 15;
    const Texel x = read(scene, centre);
    double weight = 1.0 / std::max(glm::length(x.half), 0.5);
    dvec3 sum = x.color * weight;
    for (int i = 0; i < kTaps; ++i) {
        if (i == (kTaps - 1) / 2)
            continue;
        const double t = -1.0 + 2.0 * (i + 1.0) / (kTaps + 1.0);
        const dvec2 offset = 0.5 * kDominant * t;
        const Texel y = read(scene, centre + offset);
        const double distance = glm::length(offset);
        const double alpha =
            isInFront(y.depth, x.depth) * cone(distance, glm::length(y.half)) +
            isInFront(x.depth, y.depth) * cone(distance, glm::length(x.half)) +
            2.0 * cylinder(distance, glm::length(y.half)) * cylinder(distance, glm::length(x.half));
        weight += alpha;
        sum += alpha * y.color;
    }
    return sum / weight;
}

/// Guertin 2014, its pseudocode where nothing varies: all taps along the dominant motion.
dvec3 filterGuertin(const Scene& scene, const dvec2& centre) {
    constexpr int kTaps = 15;
    const dvec2 along = glm::normalize(kDominant);
    const Texel p = read(scene, centre);
    const double speed = glm::length(p.half);
    dvec2 across(-along.y, along.x);
    if (glm::dot(across, p.half) < 0.0)
        across = -across;
    const double share = clamp01((speed - 0.5) / 1.5);
    const dvec2 second =
        share > 0.0 ? glm::normalize(glm::mix(across, p.half / speed, share)) : across;
    double weight = kTaps / (40.0 * std::max(speed, 0.5));
    dvec3 sum = p.color * weight;
    for (int i = 0; i < kTaps; ++i) {
        const double t = -1.0 + 2.0 * (i + 1.0) / (kTaps + 1.0);
        const dvec2 offset = 0.5 * kDominant * t;
        const Texel s = read(scene, centre + offset);
        const double distance = glm::length(offset);
        const double sampleSpeed = glm::length(s.half);
        const double a = std::abs(glm::dot(second, along));
        const double b = sampleSpeed > 0.0 ? std::abs(glm::dot(s.half / sampleSpeed, along)) : 0.0;
        const double alpha =
            isInFront(s.depth, p.depth) * cone(distance, sampleSpeed) * b +
            isInFront(p.depth, s.depth) * cone(distance, speed) * a +
            2.0 * cylinder(distance, std::min(sampleSpeed, speed)) * std::max(a, b);
        weight += alpha;
        sum += alpha * s.color;
    }
    return sum / weight;
}

/// Jimenez 2014: eight pairs, mirrored.
dvec3 filterJimenez(const Scene& scene, const dvec2& centre) {
    constexpr int kPairs = 8;
    const Texel target = read(scene, centre);
    const double pixelsToTaps = kPairs / (0.5 * glm::length(kDominant));
    dvec3 sum(0.0);
    double weight = 0.0;
    for (int i = 0; i < kPairs; ++i) {
        const dvec2 offset = 0.5 * kDominant * ((i + 0.5) / kPairs);
        const Texel pair[] = {read(scene, centre + offset), read(scene, centre - offset)};
        double weights[2];
        for (int k = 0; k < 2; ++k) {
            const double z = (target.depth - pair[k].depth) / kSoftExtent;
            const double distance = i + 0.5;
            const double behind = clamp01(glm::length(target.half) * pixelsToTaps - distance + 1.0);
            const double front = clamp01(glm::length(pair[k].half) * pixelsToTaps - distance + 1.0);
            weights[k] = clamp01(0.5 - z) * behind + clamp01(0.5 + z) * front;
        }
        const bool deeper = pair[0].depth > pair[1].depth;
        const bool slower = glm::length(pair[1].half) > glm::length(pair[0].half);
        const double first = deeper && slower ? weights[1] : weights[0];
        const double second = deeper || slower ? weights[1] : first;
        sum += first * pair[0].color + second * pair[1].color;
        weight += first + second;
    }
    return (sum + (2.0 * kPairs - weight) * target.color) / (2.0 * kPairs);
}

using Filter = dvec3 (*)(const Scene&, const dvec2&);

/// Single precision throughout, but the result is stored as a half float: 2^-11 of values below 1
/// (either neighbour: 2^-10). Where two speeds or depths are so alike that rounding decides, a
/// pixel may differ: one in 200.
void expectFilter(const Scene& scene, const Image& picture, Filter filter) {
    uint32_t off = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const dvec3 expected = filter(scene, {x + 0.5, y + 0.5});
            double difference = 0.0;
            for (uint32_t c = 0; c < 3; ++c)
                difference = std::max(difference, std::abs(picture.at(x, y, c) - expected[int(c)]));
            off += difference > 1.5e-3;
        }
    EXPECT_LE(off, kWidth * kHeight / 200);
    EXPECT_GT(
        test::computeMaxDifferenceWhere(picture, scene.color, [](auto, auto) { return true; }), 0.1
    ) << "it blurs";
}

TEST_F(ScreenFilters, McGuireIsThePapersInACentredExposure) {
    const Scene scene = makeScene();
    expectFilter(scene, blur(device(), scene, oneTile(&getMethod("mcguire2012"))), filterMcGuire);
}

TEST_F(ScreenFilters, GuertinIsThePapersInACentredExposure) {
    const Scene scene = makeScene();
    MotionBlurSettings settings = oneTile(&getMethod("guertin2014"));
    settings.sampleCount = 15;
    expectFilter(scene, blur(device(), scene, settings), filterGuertin);
}

TEST_F(ScreenFilters, JimenezIsThePublishedOneInACentredExposure) {
    const Scene scene = makeScene();
    MotionBlurSettings settings = oneTile(&getMethod("jimenez2014"));
    settings.sampleCount = 16;
    expectFilter(scene, blur(device(), scene, settings), filterJimenez);
    settings.sampleCount = 15; // pairs: rounded up
    expectFilter(scene, blur(device(), scene, settings), filterJimenez);
}

TEST_F(ScreenFilters, OwnVelocityIsTheMeanAlongThePixelsMotionInEveryPhase) {
    // A ramp to the right, read at nearest texels: the mean of the taps' places.
    Scene scene;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            scene.color.at(x, y, 1) = float(x) / 64.0f;
            scene.motionDepth.at(x, y, 0) = y < 16 ? 8.0f : 0.4f; // below half a pixel: still
            scene.motionDepth.at(x, y, 2) = 3.0f;
        }
    MotionBlurSettings settings = oneTile(&getMethod("own_velocity"));
    settings.sampleCount = 16;
    for (const double share : {0.0, 0.5, 1.0}) {
        const Image picture = blur(device(), scene, settings, share);
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 8; x < kWidth - 8; ++x) {
                // Taps at (i + 1/2) / 2 from -8 (1 - share) on: two in each texel they cross, but
                // for the texel at each end of an odd half.
                double expected = 0.0;
                for (int i = 0; i < 16; ++i)
                    expected += std::floor(x + 0.5 + 8.0 * ((i + 0.5) / 16.0 + share - 1.0)) / 16.0;
                ASSERT_NEAR(
                    picture.at(x, y, 1), (y < 16 ? expected : double(x)) / 64.0, 1.0 / 1024.0
                ) << x
                  << ", " << y << " share " << share;
            }
    }
}

TEST_F(ScreenFilters, TheOccluderTestKeepsAStillObjectOutOfTheBlurBehindIt) {
    // A red post that stands still before a wall that moves.
    Scene scene;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const bool post = x >= 22 && x < 26;
            scene.color.at(x, y, post ? 0 : 1) = 1.0f;
            scene.motionDepth.at(x, y, 0) = post ? 0.0f : 12.0f;
            scene.motionDepth.at(x, y, 2) = post ? 2.0f : 9.0f;
        }
    MotionBlurSettings settings = oneTile(&getMethod("own_velocity"));
    const Image plain = blur(device(), scene, settings);
    EXPECT_GT(plain.at(20, 9, 0), 0.2f) << "without it the post smears";
    settings.occluderTest = motion_blur::OccluderTest::Velocity;
    const Image tested = blur(device(), scene, settings);
    for (uint32_t x = 0; x < kWidth; ++x) {
        const bool post = x >= 22 && x < 26;
        EXPECT_EQ(tested.at(x, 9, 0), post ? 1.0f : 0.0f) << x;
        EXPECT_EQ(tested.at(x, 9, 1), post ? 0.0f : 1.0f) << x;
    }
}

TEST_F(ScreenFilters, WhereEveryTapIsAnOccluderTheSharpColourStays) {
    Scene scene;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            scene.color.at(x, y, x == 24 ? 1 : 0) = 1.0f;
            scene.motionDepth.at(x, y, 0) = x == 24 ? 400.0f : 0.0f; // no tap at its own place
            scene.motionDepth.at(x, y, 2) = x == 24 ? 9.0f : 2.0f;
        }
    MotionBlurSettings settings = oneTile(&getMethod("own_velocity"));
    settings.occluderTest = motion_blur::OccluderTest::Velocity;
    settings.sampleCount = 16;
    EXPECT_TRUE(test::sameBits(blur(device(), scene, settings), scene.color));
}

TEST_F(ScreenFilters, APixelThatMovesIsBlurredWhateverTileTheJitterFetches) {
    // A tile that moves beside one that does not, each its own neighbourhood.
    Scene scene = makeScene();
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            scene.motionDepth.at(x, y, 0) = x < 16 ? 9.0f : 0.0f;
            scene.motionDepth.at(x, y, 1) = 0.0f;
            scene.motionDepth.at(x, y, 2) = 3.0f;
        }
    for (const Method* method : {&getMethod("guertin2014"), &getMethod("jimenez2014")}) {
        MotionBlurSettings settings = oneTile(method);
        settings.tileSizePx = 16;
        settings.neighbourhoodTiles = 1;
        settings.jitter = 1.0f;
        const Image picture = blur(device(), scene, settings);
        size_t sharp = 0;
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < 16; ++x)
                sharp += std::abs(picture.at(x, y, 0) - scene.color.at(x, y, 0)) < 1e-4f &&
                         std::abs(picture.at(x, y, 1) - scene.color.at(x, y, 1)) < 1e-4f;
        EXPECT_EQ(sharp, 0u) << method->name;
    }
}

TEST_F(ScreenFilters, GuertinsSecondDirectionLooksToBothSidesOfAStillPixel) {
    // A red slab above moves up, one below moves down, what is between stands still; the dominant
    // motion runs across. At shutter close each slab was over the middle before.
    Scene scene;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const bool slab = x < 20 && (y < 6 || y >= 26); // out of reach of each other
            scene.color.at(x, y, 0) = slab ? 1.0f : 0.0f;
            scene.motionDepth.at(x, y, 1) = !slab ? 0.0f : y < 6 ? -10.0f : 10.0f;
            scene.motionDepth.at(x, y, 2) = slab ? 3.0f : 9.0f;
        }
    scene.motionDepth.at(22, 15, 0) = 12.0f;
    MotionBlurSettings settings = oneTile(&getMethod("guertin2014"));
    settings.tileSizePx = 24; // two tiles beside each other; the other one's motion goes up
    scene.motionDepth.at(40, 15, 0) = 0.6f;
    scene.motionDepth.at(40, 15, 1) = 9.0f;
    settings.sampleCount = 35;
    const Image picture = blur(device(), scene, settings, 1.0);
    EXPECT_GT(picture.at(8, 8, 0), 0.1f) << "from above";
    EXPECT_GT(picture.at(8, 23, 0), 0.1f) << "from below";
}

TEST_F(ScreenFilters, WhatOnlyStandsAcrossADominantMotionKeepsItsColour) {
    // No weight but the target's own: still pixels, each at a depth of its own, beside one mover.
    Scene scene = makeScene();
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x)
            if (x != 20 || y != 13) {
                scene.motionDepth.at(x, y, 0) = scene.motionDepth.at(x, y, 1) = 0.0f;
                scene.motionDepth.at(x, y, 2) = 3.0f;
            }
    scene.motionDepth.at(20, 13, 2) = 9.0f; // behind them all: it may cover nothing
    for (const Method* method :
         {&getMethod("mcguire2012"), &getMethod("guertin2014"), &getMethod("own_velocity")}) {
        const Image picture = blur(device(), scene, oneTile(method));
        const auto still = [](uint32_t x, uint32_t y) { return x != 20 || y != 13; };
        // A sum of one weighted colour divided by its weight, as a half float.
        EXPECT_LE(test::computeMaxDifferenceWhere(picture, scene.color, still), 1.0 / 1024.0)
            << method->name;
    }
}

TEST_F(ScreenFilters, ATileThatIsLookedUpBeyondABorderIsNotLeftOut) {
    // A mover fills the tiles at the left; with neighbourhoods of one tile only the jitter of the
    // look-up carries its smear over the border at x = 16.
    constexpr uint32_t kTile = 16;
    Scene scene = makeScene();
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            scene.motionDepth.at(x, y, 0) = x < kTile ? 14.0f : 0.0f;
            scene.motionDepth.at(x, y, 1) = 0.0f;
            scene.motionDepth.at(x, y, 2) = x < kTile ? 1.0f : 3.0f;
        }
    for (const Method* method : {&getMethod("guertin2014"), &getMethod("jimenez2014")}) {
        MotionBlurSettings settings;
        settings.method = method;
        settings.tileSizePx = kTile;
        settings.neighbourhoodTiles = 1;
        const Image blurred = blur(device(), scene, settings);
        const double across =
            test::computeMaxDifferenceWhere(blurred, scene.color, [](uint32_t x, uint32_t) {
                return x >= kTile && x < kTile + kTile / 4;
            });
        EXPECT_GT(across, 0.05) << method->name;
        const double beyond =
            test::computeMaxDifferenceWhere(blurred, scene.color, [](uint32_t x, uint32_t) {
                return x >= 2 * kTile;
            });
        EXPECT_LE(beyond, 1e-3) << method->name; // rounding to half floats
    }
}

TEST_F(ScreenFilters, MotionThatIsNotFiniteCountsAsNone) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    for (const auto& [x, y] :
         {std::pair{nan, 0.0f}, {infinity, nan}, {-infinity, infinity}, {3e38f, 3e38f}}) {
        Scene scene = makeScene();
        Scene zeroed = scene;
        std::mt19937 random(11);
        for (int i = 0; i < 200; ++i) {
            const auto column = uint32_t(random() % kWidth);
            const auto row = uint32_t(random() % kHeight);
            if (column == 20 && row == 13)
                continue;
            scene.motionDepth.at(column, row, 0) = x;
            scene.motionDepth.at(column, row, 1) = y;
            zeroed.motionDepth.at(column, row, 0) = zeroed.motionDepth.at(column, row, 1) = 0.0f;
        }
        for (const Method* method :
             {&getMethod("own_velocity"),
              &getMethod("mcguire2012"),
              &getMethod("guertin2014"),
              &getMethod("jimenez2014")}) {
            MotionBlurSettings settings = oneTile(method);
            settings.occluderTest = motion_blur::OccluderTest::Velocity;
            const Image picture = blur(device(), scene, settings);
            EXPECT_TRUE(test::allFinite(picture)) << method->name;
            EXPECT_TRUE(test::sameBits(picture, blur(device(), zeroed, settings))) << method->name;
        }
    }
}

} // namespace
} // namespace shutter
