// SPDX-License-Identifier: MIT
// What becomes of the last picture in a pixel, and where frames sample the pixel.
#include "modules/taa/taa.h"
#include "shaders/render/scene_shared.h"
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

constexpr float kLeastShare = 1.0f / float(kMostFrames);

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

TEST(TaaColor, WhatADisplayShowsStaysLinearAndABrightSampleDoesNotOutweighIt) {
    const vec3 seen(0.25f, 1.0f, 0.0f);
    EXPECT_EQ(shader::compress(seen), seen);
    EXPECT_EQ(shader::expand(seen), seen);
    EXPECT_LT(shader::compress(vec3(60000.0f)).x, 2.0f);
    EXPECT_GT(shader::compress(vec3(3.0f)).x, shader::compress(vec3(2.0f)).x);
    // What rounding has brought to the limit, or past it.
    for (const float limit : {2.0f, 2.0001f}) {
        const float expanded = shader::expand(vec3(limit)).x;
        EXPECT_GT(expanded, 0.9f * shader::kMaxColor) << limit;
        EXPECT_LT(expanded, 1.1f * shader::kMaxColor) << limit;
    }
}

TEST(TaaHistory, FirstFramesAreThePlainMeanAndThenEachHasTheLeastShare) {
    const ColorMoments moments = makeMoments(0.5f, 0.4f);
    Kept kept{vec3(0.25f), 1.0f};
    kept = shader::mixWithLast(vec3(0.5f), moments, kept, kLeastShare);
    EXPECT_EQ(kept.count, 2.0f);
    EXPECT_NEAR(kept.color.x, 0.375f, 1e-5f);
    kept = shader::mixWithLast(vec3(0.5f), moments, kept, kLeastShare);
    EXPECT_EQ(kept.count, 3.0f);
    EXPECT_NEAR(kept.color.x, (0.25f + 0.5f + 0.5f) / 3.0f, 1e-5f);
    for (int i = 0; i < 100; ++i)
        kept = shader::mixWithLast(vec3(0.5f), moments, kept, kLeastShare);
    EXPECT_EQ(kept.count, float(kMostFrames));
    EXPECT_NEAR(kept.color.x, 0.5f, 1e-2f);
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

TEST(TaaDepth, OnlyWhatIsClearlyNearerHides) {
    for (const float depth : {0.01f, 1.0f, 4000.0f, shader::kSkyDepth}) {
        EXPECT_TRUE(shader::hides(0.9f * depth, depth)) << depth;
        EXPECT_FALSE(shader::hides(0.99f * depth, depth)) << depth; // the same, rounded
        EXPECT_FALSE(shader::hides(depth, depth)) << depth;
        EXPECT_FALSE(shader::hides(2.0f * depth, depth)) << depth;
    }
}

TEST(TaaDepth, ASampleOfWhatLiesBeforeOrBehindIsOfSomethingElse) {
    const shader::DepthRange alone{4.0f, 4.0f};
    EXPECT_TRUE(shader::wasSeen(alone, 4.0f));
    EXPECT_FALSE(shader::wasSeen(alone, 3.0f));
    EXPECT_FALSE(shader::wasSeen(alone, 5.0f));
    const shader::DepthRange atAnEdge{3.0f, 5.0f};
    for (const float sampled : {3.0f, 4.0f, 5.0f})
        EXPECT_TRUE(shader::wasSeen(atAnEdge, sampled)) << sampled;
    EXPECT_FALSE(shader::wasSeen(atAnEdge, 2.0f));
    EXPECT_FALSE(shader::wasSeen(atAnEdge, 6.0f));
    EXPECT_TRUE(shader::wasSeen({shader::kSkyDepth, shader::kSkyDepth}, shader::kSkyDepth));
}

TEST(TaaDepth, WhatGetsAFractionOfAPixelApartMovesAlong) {
    EXPECT_TRUE(shader::movesAlong(vec2(7.0f, -2.0f), vec2(7.3f, -2.3f)));
    EXPECT_FALSE(shader::movesAlong(vec2(7.0f, -2.0f), vec2(7.6f, -2.0f)));
    EXPECT_FALSE(shader::movesAlong(vec2(7.0f, -2.0f), vec2(7.0f, -3.0f)));
    EXPECT_FALSE(shader::movesAlong(vec2(0.0f), vec2(std::numeric_limits<float>::quiet_NaN())));
}

TEST(TaaMiddle, IsOfSamplesWhereverTheyLie) {
    for (const float offset : {-0.5f, -0.2f, 0.0f, 0.4f, 0.5f}) {
        const vec3 weights = shader::findMiddleWeights(offset);
        for (int i = 0; i < 3; ++i)
            EXPECT_GE(weights[i], 0.0f);
        EXPECT_NEAR(weights.x + weights.y + weights.z, 1.0f, 1e-6f);
        // The samples' mean place is the pixel's middle.
        const vec3 places(offset - 1.0f, offset, offset + 1.0f);
        EXPECT_NEAR(glm::dot(weights, places), 0.0f, 1e-6f);
    }
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
