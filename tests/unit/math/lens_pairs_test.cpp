// SPDX-License-Identifier: MIT
#include "engine/math/lens_pairs.h"
#include "shaders/common/aperture.glsl"
#include "shaders/common/instant_motion_shared.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace shutter::math {
namespace {

constexpr uint32_t kSets = shader::kLensSets;

/// Which of count x rows equal parts of the lens a place is in.
uint32_t partOf(const dvec2& place, uint32_t columns, uint32_t rows) {
    return uint32_t(place.y * rows) * columns + uint32_t(place.x * columns);
}

TEST(LensPairs, EachSetHasOnePlaceInEachPartOfTheLensAndOneTimeInEachOfTheExposure) {
    for (const uint32_t samples : {4u, 16u, 32u}) {
        const auto pairs = spreadLensPairs(samples);
        ASSERT_EQ(pairs.size(), size_t(samples) * kSets);
        for (uint32_t set = 0; set < kSets; ++set)
            for (uint32_t columns = 1; columns <= samples; columns *= 2) {
                std::set<uint32_t> parts;
                for (uint32_t i = 0; i < samples; ++i) {
                    const LensPair& pair = pairs[i * kSets + set];
                    parts.insert(partOf(pair.place, columns, samples / columns));
                    EXPECT_EQ(uint32_t(pair.light * samples), i);
                }
                EXPECT_EQ(parts.size(), samples) << set << " " << columns;
            }
    }
}

TEST(LensPairs, AllSetsTogetherAreSpreadAsEvenlyAsOneOfSoManySamples) {
    constexpr uint32_t kSamples = 16;
    const auto pairs = spreadLensPairs(kSamples);
    std::set<uint32_t> parts;
    std::set<uint32_t> times;
    for (const LensPair& pair : pairs) {
        parts.insert(partOf(pair.place, kSamples, kSets));
        times.insert(uint32_t(pair.light * kSamples));
    }
    EXPECT_EQ(parts.size(), pairs.size());
    EXPECT_EQ(times.size(), kSamples);
}

TEST(LensPairs, PlacesOfAllSetsHaveTheWidthOfTheDisc) {
    for (const uint32_t samples : {4u, 15u, 16u, 32u}) {
        double square = 0.0;
        const auto pairs = spreadLensPairs(samples);
        for (const LensPair& pair : pairs) {
            const vec2 place = shader::aperturePoint({0, 0.0f, 1.0f, 1.0f}, vec2(pair.place));
            square += dot(place, place) / double(pairs.size());
        }
        EXPECT_NEAR(square, 0.5, 0.002) << samples;
    }
}

TEST(LensPairs, SetsOfAnyNumberOfSamplesLieAboutTheMiddleOfTheLens) {
    for (const uint32_t samples : {1u, 7u, 15u, 24u, 32u}) {
        const auto pairs = spreadLensPairs(samples);
        for (uint32_t set = 0; set < kSets; ++set) {
            dvec2 mean(0.0);
            for (uint32_t i = 0; i < samples; ++i) {
                const LensPair& pair = pairs[i * kSets + set];
                EXPECT_GT(pair.light, 0.0);
                EXPECT_LT(pair.light, 1.0);
                mean += pair.place / double(samples);
            }
            EXPECT_NEAR(mean.x, 0.5, 0.5 / samples) << samples << " " << set;
            EXPECT_NEAR(mean.y, 0.5, 0.5 / samples) << samples << " " << set;
        }
    }
}

TEST(LensPairs, FramesThatTakeTurnsGiveEachSetThePlacesOfAllSets) {
    for (const uint32_t samples : {1u, 15u, 16u}) {
        const auto once = spreadLensPairs(samples);
        for (const uint32_t set : {0u, 1u, 10u}) {
            std::multiset<std::pair<double, double>> places;
            for (uint32_t turn = 0; turn < kSets; ++turn) {
                const auto pairs = spreadLensPairs(samples, turn);
                for (uint32_t i = 0; i < samples; ++i) {
                    const LensPair& pair = pairs[i * kSets + set];
                    places.emplace(pair.place.x, pair.place.y);
                    EXPECT_EQ(pair.light, once[i * kSets].light);
                }
            }
            std::multiset<std::pair<double, double>> all;
            for (const LensPair& pair : once)
                all.emplace(pair.place.x, pair.place.y);
            EXPECT_EQ(places, all) << samples << " " << set;
        }
    }
    const auto first = spreadLensPairs(15, 3);
    const auto again = spreadLensPairs(15, 3 + kSets);
    for (size_t i = 0; i < first.size(); ++i)
        EXPECT_EQ(first[i].place, again[i].place) << i;
}

} // namespace
} // namespace shutter::math
