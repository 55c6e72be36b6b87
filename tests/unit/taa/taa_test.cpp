// SPDX-License-Identifier: MIT
// What becomes of the last picture in a pixel, and where frames sample the pixel.
#include "modules/taa/taa.h"
#include "shaders/taa/taa.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace shutter::taa {
namespace {

using math::dvec2;
using math::vec2;
using math::vec3;
using shader::ColorMoments;
using shader::Kept;

constexpr float kLeastShare = 1.0f / float(kPlaceCount);

/// Moments of a neighbourhood that spreads evenly around a grey.
ColorMoments makeMoments(float middle, float spread) {
    ColorMoments moments{vec3(0.0f), vec3(0.0f), 0.0f};
    for (const float offset : {-spread, 0.0f, spread})
        moments = shader::addColor(
            moments, shader::ycocgFromRgb(shader::compress(vec3(middle + offset)))
        );
    return moments;
}

TEST(TaaPlaces, LieInThePixelOnceEachAndAroundItsCentre) {
    dvec2 sum(0.0);
    for (int64_t i = 0; i < int64_t{kPlaceCount}; ++i) {
        const dvec2 place = computeJitterPx(i);
        EXPECT_LT(std::abs(place.x), 0.5);
        EXPECT_LT(std::abs(place.y), 0.5);
        EXPECT_EQ(place, computeJitterPx(i + kPlaceCount));
        EXPECT_EQ(place, computeJitterPx(i - 3 * int64_t{kPlaceCount})); // before time 0
        for (int64_t j = 0; j < i; ++j)
            EXPECT_NE(place, computeJitterPx(j));
        sum += place;
    }
    EXPECT_LT(glm::length(sum / double(kPlaceCount)), 0.05);
}

TEST(TaaPlaces, AViewDiffersInItsPlaceAndItsTexturesAlone) {
    extract::ViewRequest view;
    view.width = 33;
    view.lodBias = 0.25f;
    const extract::ViewRequest jittered = makeJittered(view, 5);
    EXPECT_EQ(jittered.jitterPx, computeJitterPx(5));
    EXPECT_LT(jittered.lodBias, view.lodBias);
    EXPECT_EQ(jittered.width, 33u);
}

TEST(TaaColor, EncodingsComeBack) {
    for (const float value : {0.0f, 0.01f, 1.0f, 37.0f, 65000.0f}) {
        const vec3 color(value, 0.5f * value, 0.25f * value);
        const vec3 back =
            shader::expand(shader::rgbFromYcocg(shader::ycocgFromRgb(shader::compress(color))));
        EXPECT_NEAR(back.x, color.x, 0.02f * value + 1e-6f);
        EXPECT_NEAR(back.y, color.y, 0.02f * value + 1e-6f);
        EXPECT_NEAR(back.z, color.z, 0.02f * value + 1e-6f);
    }
}

TEST(TaaHistory, FirstFramesAreThePlainMeanAndThenEachHasTheLeastShare) {
    const ColorMoments moments = makeMoments(0.5f, 0.4f);
    // Means are of what is seen: compressed, the two are 0.2 and 1/3.
    Kept kept{vec3(0.25f), 1.0f};
    kept = shader::mixWithLast(vec3(0.5f), moments, kept, kLeastShare);
    EXPECT_EQ(kept.count, 2.0f);
    const float mean = 0.5f * (0.2f + 1.0f / 3.0f);
    EXPECT_NEAR(kept.color.x, mean / (1.0f - mean), 1e-4f);
    for (int i = 0; i < 100; ++i)
        kept = shader::mixWithLast(vec3(0.5f), moments, kept, kLeastShare);
    EXPECT_EQ(kept.count, float(kPlaceCount));
    EXPECT_NEAR(kept.color.x, 0.5f, 1e-3f);
}

TEST(TaaHistory, WhatNoNeighbourLooksLikeIsClippedAndTrustedLess) {
    const Kept ghost{vec3(5.0f), float(kPlaceCount)};
    const Kept kept = shader::mixWithLast(vec3(0.2f), makeMoments(0.2f, 0.01f), ghost, kLeastShare);
    EXPECT_NEAR(kept.color.x, 0.2f, 0.02f);
    EXPECT_LE(kept.count, 2.0f);
}

TEST(TaaHistory, NanInfinityAndEmptinessCountAsNothing) {
    const ColorMoments moments = makeMoments(0.5f, 0.4f);
    const float infinity = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Kept& last :
         {Kept{vec3(nan, 0.5f, 0.5f), 4.0f},
          Kept{vec3(0.5f, infinity, 0.5f), 4.0f},
          Kept{vec3(0.5f, 0.5f, -infinity), 4.0f},
          Kept{vec3(0.5f), nan},
          Kept{vec3(0.5f), infinity},
          Kept{vec3(0.5f), 0.0f}}) {
        const Kept kept = shader::mixWithLast(vec3(0.25f), moments, last, kLeastShare);
        EXPECT_EQ(kept.color, vec3(0.25f));
        EXPECT_EQ(kept.count, 1.0f);
    }
}

TEST(TaaHistory, ALastPictureBelowBlackIsBlack) {
    // Catmull-Rom's overshoot.
    const Kept kept =
        shader::mixWithLast(vec3(0.0f), makeMoments(0.0f, 0.0f), {vec3(-0.9f), 8.0f}, kLeastShare);
    EXPECT_TRUE(std::isfinite(kept.color.x));
    EXPECT_NEAR(kept.color.x, 0.0f, 1e-3f);
}

TEST(TaaTaps, AreCatmullRomsCubic) {
    for (const float f : {0.0f, 0.25f, 0.5f, 0.9f}) {
        const shader::CubicTaps taps = shader::findCubicTaps(vec2(7.5f + f, 3.5f + f));
        EXPECT_NEAR(taps.beforeWeight.x + taps.middleWeight.x + taps.afterWeight.x, 1.0f, 1e-6f);
        // A straight line comes back: each tap at its place, in weights' mean.
        const float at = taps.before.x * taps.beforeWeight.x + taps.middle.x * taps.middleWeight.x +
                         taps.after.x * taps.afterWeight.x;
        EXPECT_NEAR(at, 7.5f + f, 1e-4f);
    }
    EXPECT_EQ(shader::findCubicTaps(vec2(7.5f)).middle, vec2(7.5f)); // a texel is itself
    EXPECT_EQ(shader::findCubicTaps(vec2(7.5f)).beforeWeight, vec2(0.0f));
}

} // namespace
} // namespace shutter::taa
