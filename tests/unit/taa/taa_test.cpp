// SPDX-License-Identifier: MIT
// The update of a pixel's accumulated colour, and the sample places of frames.
#include "modules/taa/taa.h"
#include "shaders/render/scene_shared.h"
#include "shaders/taa/taa.glsl"

#include <gtest/gtest.h>

#include <cmath>

namespace shutter::taa {
namespace {

using math::dvec2;
using math::vec2;
using math::vec3;
using shader::ColorMoments;
using shader::Kept;

/// Moments of a neighbourhood that spreads evenly around a grey.
ColorMoments makeMoments(float middle, float spread) {
    ColorMoments moments{vec3(0.0f), vec3(0.0f), 0.0f};
    for (const float offset : {-spread, 0.0f, spread})
        moments = shader::addColor(
            moments, shader::ycocgFromRgb(shader::compress(vec3(middle + offset)))
        );
    return moments;
}

TEST(TaaPlaces, PlacesAreDistinctInThePixelAndAroundItsCentre) {
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
    EXPECT_LT(glm::length(sum), 1e-12);
}

TEST(TaaPlaces, AViewDiffersInItsPlaceAndItsTexturesAlone) {
    extract::ViewRequest view;
    view.width = 33;
    view.lodBias = 0.25f;
    const extract::ViewRequest jittered = makeJittered(view, 5);
    EXPECT_EQ(jittered.jitterPx, computeJitterPx(5));
    EXPECT_EQ(jittered.jittered, extract::Jittered::Static);
    EXPECT_LT(jittered.lodBias, view.lodBias);
    EXPECT_LT(jittered.staticLodBias, 0.0f);
    EXPECT_EQ(jittered.width, 33u);
}

TEST(TaaColor, EncodingsComeBack) {
    for (const float value : {0.0f, 0.01f, 1.0f, 37.0f, 65000.0f}) {
        const vec3 color(value, 0.5f * value, 0.25f * value);
        const vec3 back =
            shader::expand(shader::rgbFromYcocg(shader::ycocgFromRgb(shader::compress(color))));
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(back[i], color[i], 0.02f * value + 1e-6f);
    }
}

TEST(TaaColor, DisplayableColoursStayLinearAndBrightSamplesAreCompressed) {
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

constexpr Kept kNothing{shader::ivec3(0), 0.0f, 0u, vec3(0.0f)};

/// Where static surfaces are unchanged, with any neighbours.
Kept add(float grey, Kept last) {
    return shader::addFrame(vec3(grey), last, false, makeMoments(0.0f, 0.0f));
}

Kept addInDoubt(float grey, Kept last, const ColorMoments& moments) {
    return shader::addFrame(vec3(grey), last, true, moments);
}

Kept makeKept(float grey, float count) {
    return {shader::toSteps(vec3(grey * count)), count, 0u, vec3(0.0f)};
}

TEST(TaaHistory, EachFrameHasAnEqualShareUntilThereIsOnePerPlaceAndThenTheMeanStays) {
    Kept kept = add(0.25f, kNothing);
    EXPECT_EQ(kept.count, 1.0f);
    EXPECT_EQ(shader::meanOf(kept), vec3(0.25f));
    for (uint32_t i = 1; i < kPlaceCount; ++i)
        kept = add(0.5f, kept);
    EXPECT_EQ(kept.count, float(kPlaceCount));
    EXPECT_NEAR(shader::meanOf(kept).x, 0.5f - 0.25f / float(kPlaceCount), 1e-6f);
    const Kept next = add(0.75f, kept);
    EXPECT_EQ(next.sum, kept.sum);
    EXPECT_EQ(next.count, kept.count);
}

TEST(TaaHistory, TheSumDoesNotDependOnTheOrderOfFrames) {
    Kept forwards = kNothing;
    Kept backwards = kNothing;
    for (uint32_t i = 0; i < kPlaceCount; ++i) {
        const auto grey = [](uint32_t index) { return 1.9f / std::pow(3.0f, float(index)); };
        forwards = add(grey(i), forwards);
        backwards = add(grey(kPlaceCount - 1 - i), backwards);
    }
    EXPECT_EQ(forwards.sum, backwards.sum);
}

TEST(TaaHistory, TheBrightestColorsDoNotOverflowTheSum) {
    Kept kept = kNothing;
    for (uint32_t i = 0; i < 2 * kPlaceCount; ++i)
        kept = addInDoubt(2.0f, kept, makeMoments(70000.0f, 0.0f));
    EXPECT_NEAR(shader::meanOf(kept).x, 2.0f, 1e-4f);
}

TEST(TaaHistory, AColorInDoubtIsClippedToItsNeighboursAndTrustedLess) {
    const Kept ghost = makeKept(1.8f, float(kPlaceCount));
    Kept kept = addInDoubt(0.2f, ghost, makeMoments(0.2f, 0.01f));
    EXPECT_NEAR(shader::meanOf(kept).x, 0.2f, 0.02f);
    EXPECT_LE(kept.count, 2.0f);
    // A settled pixel in doubt takes each frame.
    kept = makeKept(0.3f, float(kPlaceCount));
    for (int i = 0; i < 200; ++i)
        kept = addInDoubt(0.5f, kept, makeMoments(0.4f, 0.4f));
    EXPECT_NEAR(shader::meanOf(kept).x, 0.5f, 1e-3f);
}

/// As the next frame finds it.
Kept keep(const Kept& kept) {
    return shader::unpackKept(shader::packSums(kept), shader::packCounts(kept));
}

TEST(TaaHistory, NothingOfAMeanInDoubtIsLeftOnceThereIsAFramePerPlaceAndThenItStays) {
    // The neighbourhood's colours spread so far that the old one is not clipped.
    Kept kept = makeKept(0.3f, float(kPlaceCount));
    for (int i = 0; i < 2; ++i)
        kept = keep(addInDoubt(0.5f, kept, makeMoments(0.4f, 0.4f)));
    float mean = 0.0f;
    for (uint32_t i = 0; i < kPlaceCount; ++i) {
        const float before = shader::meanOf(kept).x;
        const float grey = 0.5f + 0.02f * float(i);
        mean += grey / float(kPlaceCount);
        kept = keep(add(grey, kept));
        // A frame counts for no more than it does in the end: nothing flickers meanwhile.
        EXPECT_LT(std::abs(shader::meanOf(kept).x - before), 0.6f / float(kPlaceCount)) << i;
    }
    EXPECT_NEAR(shader::meanOf(kept).x, mean, 1e-4f);
    const Kept next = add(0.9f, kept);
    EXPECT_EQ(next.sum, kept.sum);
    EXPECT_EQ(next.count, kept.count);
}

TEST(TaaHistory, WhatIsStoredComesBack) {
    for (const float count : {0.0f, 1.0f, 4.75f, 16.0f})
        for (const uint32_t left : {0u, 1u, kPlaceCount - 1u, kPlaceCount}) {
            const Kept kept{
                shader::toSteps(vec3(32.0f, 0.0f, 1.0f)), count, left, vec3(2.0f, 0.0f, 0.25f)};
            const Kept back = keep(kept);
            EXPECT_EQ(back.count, count);
            EXPECT_EQ(back.left, left);
            for (int i = 0; i < 3; ++i) {
                EXPECT_NEAR(
                    float(back.sum[i]), float(kept.sum[i]), shader::fades(kept) ? 256.0f : 0.0f
                );
                if (shader::fades(kept)) {
                    EXPECT_NEAR(back.fading[i], kept.fading[i], 0.001f);
                }
            }
        }
}

TEST(TaaHistory, AThinLineMissedByOneFrameStaysWithoutADoubt) {
    const Kept line = makeKept(0.3f, 4.0f); // seen by one frame of three
    const Kept kept = add(0.0f, line);
    EXPECT_NEAR(shader::meanOf(kept).x, 0.24f, 1e-5f);
    EXPECT_EQ(kept.count, 5.0f);
    EXPECT_LT(shader::meanOf(addInDoubt(0.0f, line, makeMoments(0.0f, 0.0f))).x, 0.01f);
}

TEST(TaaMiddle, TheMiddleIsReconstructedFromSamplesAtAnyOffset) {
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

} // namespace
} // namespace shutter::taa
