// SPDX-License-Identifier: MIT
#include "modules/accumulate/accumulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace shutter::accumulate {
namespace {

using math::dvec2;

std::vector<extract::ViewRequest> makeAll(uint32_t count, uint32_t seed) {
    std::vector<extract::ViewRequest> instants;
    for (uint32_t i = 0; i < count; ++i)
        instants.push_back(makeInstant({}, i, count, PixelModel::Box, seed));
    return instants;
}

TEST(MakeInstant, EveryStratumOfTheExposureIsSeenInItsMiddleByThePixelsCentre) {
    extract::ViewRequest view;
    view.lodBias = 0.5f;
    for (const uint32_t count : {1u, 2u, 7u, 64u})
        for (uint32_t i = 0; i < count; ++i) {
            const auto instant = makeInstant(view, i, count, PixelModel::Centre, 9);
            EXPECT_NEAR(instant.instant.value(), (i + 0.5) / count, 1e-12);
            EXPECT_EQ(instant.jitterPx, dvec2(0.0));
            EXPECT_EQ(instant.lodBias, 0.5f);
        }
}

TEST(MakeInstant, AResponseHasTheInstantsWhereItsLightIs) {
    extract::ViewRequest view;
    view.exposure.shutter.response.shape = scene::ResponseShape::Triangle;
    for (uint32_t i = 0; i < 64; ++i) {
        const double u = (i + 0.5) / 64.0;
        const double expected = u < 0.5 ? std::sqrt(u / 2.0) : 1.0 - std::sqrt((1.0 - u) / 2.0);
        const auto instant = makeInstant(view, i, 64, PixelModel::Centre, 0);
        EXPECT_NEAR(instant.instant.value(), expected, 1e-5);
    }
}

TEST(MakeInstant, TheBoxCoversThePixelEvenly) {
    for (const uint32_t seed : {0u, 1u, 4294967295u}) {
        constexpr uint32_t kCount = 256;
        std::vector<int> cells(16, 0);
        dvec2 sum(0.0);
        for (const auto& instant : makeAll(kCount, seed)) {
            const dvec2 place = instant.jitterPx + 0.5;
            ASSERT_TRUE(place.x >= 0.0 && place.x < 1.0 && place.y >= 0.0 && place.y < 1.0);
            ++cells[size_t(place.x * 4.0) + 4 * size_t(place.y * 4.0)];
            sum += instant.jitterPx;
        }
        for (const int count : cells)
            EXPECT_NEAR(count, 16, 4) << seed;
        EXPECT_NEAR(sum.x / kCount, 0.0, 0.01);
        EXPECT_NEAR(sum.y / kCount, 0.0, 0.01);
    }
}

TEST(MakeInstant, EachHalfOfTheExposureCoversThePixelToo) {
    // Place and time are independent: no part of the pixel is seen in one half only.
    const auto instants = makeAll(128, 0);
    for (const uint32_t begin : {0u, 64u}) {
        std::vector<int> cells(4, 0);
        for (uint32_t i = begin; i < begin + 64; ++i)
            ++cells
                [size_t(instants[i].jitterPx.x >= 0.0) + 2 * size_t(instants[i].jitterPx.y >= 0.0)];
        for (const int count : cells)
            EXPECT_NEAR(count, 16, 4);
    }
}

TEST(MakeInstant, TimesPlacesInTheLensAndInThePixelAreIndependent) {
    extract::ViewRequest view;
    EXPECT_FALSE(makeInstant(view, 0, 1, PixelModel::Box, 0).lensPlace);
    view.usesLens = true;
    constexpr uint32_t kCount = 256;
    std::vector<std::vector<double>> samples;
    for (uint32_t i = 0; i < kCount; ++i) {
        const auto instant = makeInstant(view, i, kCount, PixelModel::Box, 0);
        const dvec2 lens = instant.lensPlace.value();
        const dvec2 pixel = instant.jitterPx + 0.5;
        samples.push_back({*instant.instant, lens.x, lens.y, pixel.x, pixel.y});
    }
    for (int a = 0; a < 5; ++a)
        for (int b = 0; b < a; ++b) {
            std::vector<int> cells(16, 0);
            for (const std::vector<double>& sample : samples) {
                ASSERT_TRUE(sample[a] >= 0.0 && sample[a] < 1.0);
                ++cells[size_t(sample[a] * 4.0) * 4 + size_t(sample[b] * 4.0)];
            }
            for (const int count : cells)
                EXPECT_NEAR(count, 16, 5) << a << " and " << b;
        }
}

TEST(MakeInstant, OneBoxSampleLiesInTheMiddleAndManyResolveFinerTextures) {
    const auto instant = makeInstant({}, 0, 1, PixelModel::Box, 0);
    EXPECT_EQ(instant.jitterPx, dvec2(0.0));
    EXPECT_EQ(instant.lodBias, 0.0f);
    EXPECT_FLOAT_EQ(makeInstant({}, 0, 16, PixelModel::Box, 0).lodBias, -2.0f);
}

TEST(MakeInstant, SeedsDetermineThePlaces) {
    std::set<std::pair<double, double>> firsts;
    for (uint32_t seed = 0; seed < 50; ++seed) {
        const dvec2 place = makeInstant({}, 3, 16, PixelModel::Box, seed).jitterPx;
        firsts.insert({place.x, place.y});
        EXPECT_EQ(place, makeInstant({}, 3, 16, PixelModel::Box, seed).jitterPx);
    }
    EXPECT_EQ(firsts.size(), 50u);
}

TEST(MakeInstant, TheRestOfTheViewStaysAsRequested) {
    extract::ViewRequest view;
    view.width = 7;
    view.height = 5;
    view.background = {1.0f, 2.0f, 3.0f};
    view.unlit = true;
    view.exposure = {2.0, 4.0, 4.0, 1.0};
    const auto instant = makeInstant(view, 1, 2, PixelModel::Box, 0);
    EXPECT_EQ(instant.width, 7u);
    EXPECT_EQ(instant.height, 5u);
    EXPECT_EQ(instant.background, view.background);
    EXPECT_TRUE(instant.unlit);
    EXPECT_EQ(instant.exposure.open, 2.0);
    EXPECT_EQ(instant.exposure.close, 4.0);
}

} // namespace
} // namespace shutter::accumulate
