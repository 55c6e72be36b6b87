// SPDX-License-Identifier: MIT
// Places of a lens: how they are spread, how wide they are in pixels, and the disc that a bright
// point makes of them.
#include "engine/math/lens_pairs.h"
#include "engine/math/lens_tables.h"
#include "engine/math/math.h"
#include "shaders/common/aperture.glsl"
#include "shaders/common/instant_motion_shared.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace shutter::shader {

using glm::atan;

/// GLSL leaves the angle of 0, 0 undefined, which C++ defines.
inline float atan(float y, float x) {
    return x == 0.0f && y == 0.0f ? std::numeric_limits<float>::quiet_NaN() : std::atan2(y, x);
}

} // namespace shutter::shader

#include "shaders/common/disc_share.glsl"

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
    std::set<uint32_t> parts;
    const auto pairs = spreadLensPairs(16);
    for (const LensPair& pair : pairs)
        parts.insert(partOf(pair.place, 16, kSets));
    EXPECT_EQ(parts.size(), pairs.size());
}

TEST(LensPairs, SetsOfAnyNumberOfSamplesLieAboutTheMiddleOfTheLensAndHaveTheWidthOfTheDisc) {
    for (const uint32_t samples : {1u, 4u, 7u, 15u, 16u, 24u, 32u}) {
        const auto pairs = spreadLensPairs(samples);
        double square = 0.0;
        std::vector<dvec2> means(kSets, dvec2(0.0));
        for (size_t i = 0; i < pairs.size(); ++i) {
            EXPECT_GT(pairs[i].light, 0.0);
            EXPECT_LT(pairs[i].light, 1.0);
            means[i % kSets] += pairs[i].place / double(samples);
            const vec2 place = shader::aperturePoint({0, 0.0f, 1.0f, 1.0f}, vec2(pairs[i].place));
            square += dot(place, place) / double(pairs.size());
        }
        for (const dvec2& mean : means) {
            EXPECT_NEAR(mean.x, 0.5, 0.5 / samples) << samples;
            EXPECT_NEAR(mean.y, 0.5, 0.5 / samples) << samples;
        }
        if (samples == 4 || samples >= 15) {
            EXPECT_NEAR(square, 0.5, 0.002) << samples;
        }
    }
}

TEST(LensPairs, FramesThatTakeTurnsGiveEachSetThePlacesOfAllSets) {
    using Places = std::multiset<std::pair<double, double>>;
    for (const uint32_t samples : {1u, 15u, 16u}) {
        const auto once = spreadLensPairs(samples);
        Places all;
        for (const LensPair& pair : once)
            all.emplace(pair.place.x, pair.place.y);
        for (const uint32_t set : {0u, 1u, 10u}) {
            Places places;
            for (uint32_t turn = 0; turn < kSets; ++turn) {
                const auto pairs = spreadLensPairs(samples, turn);
                const auto again = spreadLensPairs(samples, turn + kSets);
                for (uint32_t i = 0; i < samples; ++i) {
                    const LensPair& pair = pairs[i * kSets + set];
                    places.emplace(pair.place.x, pair.place.y);
                    EXPECT_EQ(pair.light, once[i * kSets].light);
                    EXPECT_EQ(again[i * kSets + set].place, pair.place) << turn;
                }
            }
            EXPECT_EQ(places, all) << samples << " " << set;
        }
    }
}

InstantLayers addTo(const ThinLens& lens) {
    InstantLayers layers;
    layers.times = {0.5f};
    const std::vector<ThinLens> lenses = {lens};
    addLens(lenses, lens, 0, layers);
    return layers;
}

TEST(LensTables, TheOpeningIsAsWideInPixelsAsThePlacesOfTheLensMoveAPicture) {
    // A host's pixels may be twice as wide as high.
    const ThinLens square{
        .pixelsPerUnit = {100.0, 100.0},
        .radius = 0.1,
        .focusDistance = 2.0,
        .aperture = {.blades = 0, .rotation = 0.0f, .roundness = 0.0f, .squeeze = 1.0f}};
    ThinLens wide = square;
    wide.pixelsPerUnit.x = 50.0;
    const InstantLayers one = addTo(square);
    const InstantLayers other = addTo(wide);
    EXPECT_FLOAT_EQ(one.aperture.w, 1.0f);
    EXPECT_FLOAT_EQ(other.aperture.w, 0.5f);
    ASSERT_EQ(one.lens.size(), other.lens.size());
    for (size_t i = 0; i < one.lens.size(); ++i) {
        EXPECT_FLOAT_EQ(other.lens[i].z, one.lens[i].z * other.aperture.w) << i;
        EXPECT_FLOAT_EQ(other.lens[i].w, one.lens[i].w) << i;
    }
    EXPECT_FLOAT_EQ(other.lensReaches.back().radius, 10.0f);
}

using shader::Aperture;

TEST(DiscShare, TheMiddleOfABladedDiscIsInside) {
    for (const uint32_t blades : {0u, 3u, 6u})
        for (const float confusion : {-8.0f, 8.0f}) {
            const Aperture aperture{blades, 0.4f, 0.0f, 1.0f};
            const float inside = shader::insideDisc(aperture, vec2(0.0f), confusion);
            EXPECT_TRUE(std::isfinite(inside)) << blades;
            EXPECT_GT(inside, 2.0f) << blades;
        }
}

TEST(DiscShare, ADiscHasTheLightOfItsPoint) {
    for (const Aperture& aperture :
         {Aperture{0, 0.0f, 0.0f, 1.0f},
          Aperture{0, 0.0f, 0.0f, 0.5f},
          Aperture{0, 0.0f, 0.0f, 2.0f},
          Aperture{3, 0.4f, 0.0f, 1.0f},
          Aperture{6, 1.0f, 0.3f, 1.5f}})
        for (const float narrowest : {-3.0f, 8.0f, 40.0f}) // 3 pixels is the smallest
            for (const float width : {0.5f, 2.0f}) {
                const float confusion = narrowest / std::min(aperture.squeeze, 1.0f);
                const float area = shader::apertureArea(aperture);
                double light = 0.0;
                for (int y = -90; y < 90; ++y)
                    for (int x = -90; x < 90; ++x)
                        light += double(shader::shareOfDisc(
                            aperture, vec2(float(x) + 0.3f, float(y) - 0.4f), confusion, area, width
                        ));
                EXPECT_NEAR(light, 1.0, aperture.blades == 3 && narrowest < 8.0f ? 0.01 : 0.005)
                    << aperture.blades << " " << aperture.squeeze << " " << confusion << " "
                    << width;
            }
}

} // namespace
} // namespace shutter::math
