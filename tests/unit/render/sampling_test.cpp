// SPDX-License-Identifier: MIT
#include "shaders/common/sampling.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace shutter::shader {

TEST(ShutterTime, EveryPrefixOfAPowerOfTwoHasOneRayAStratum) {
    for (const uint seed : {0u, 1u, 77u, 0xFFFFFFFFu})
        for (uint count = 1; count <= 1024; count *= 2) {
            std::set<uint> strata;
            for (uint i = 0; i < count; ++i) {
                const float s = shutterTime(i, seed);
                ASSERT_TRUE(s >= 0.0f && s < 1.0f);
                strata.insert(uint(s * float(count)));
            }
            EXPECT_EQ(strata.size(), count) << seed;
        }
}

TEST(ShutterTime, SoHasEveryAlignedRun) {
    for (uint first = 0; first < 4096; first += 64) {
        std::set<uint> strata;
        for (uint i = first; i < first + 64; ++i)
            strata.insert(uint(shutterTime(i, 5u) * 64.0f));
        EXPECT_EQ(strata.size(), 64u);
    }
}

TEST(ShutterTime, EachRayAloneIsUniformOverTheExposure) {
    // Whatever the ray: over many pixels its times cover the exposure, so that a picture of any
    // number of rays is not biased. 1024 pixels in 8 bins: 128 +- 10.6.
    for (const uint ray : {0u, 1u, 2u, 100u}) {
        std::vector<int> bins(8, 0);
        for (uint y = 0; y < 32; ++y)
            for (uint x = 0; x < 32; ++x)
                ++bins[size_t(shutterTime(ray, hashPixel(uvec2(x, y), 3u, 0u)) * 8.0f)];
        for (const int count : bins)
            EXPECT_NEAR(count, 128, 53) << ray;
    }
}

TEST(ShutterTime, WithinItsStratumARayIsAnywhere) {
    std::vector<int> bins(8, 0);
    for (uint seed = 0; seed < 1024; ++seed) {
        const float inStratum = shutterTime(9u, hashPcg(seed)) * 16.0f;
        ++bins[size_t((inStratum - std::floor(inStratum)) * 8.0f)];
    }
    for (const int count : bins)
        EXPECT_NEAR(count, 128, 53);
}

TEST(ShutterTime, TwoSetsOfAPixelAreIndependent) {
    double covariance = 0.0;
    for (uint x = 0; x < 4096; ++x) {
        const double a = double(shutterTime(0u, hashPixel(uvec2(x, 7), 0u, 0u))) - 0.5;
        const double b = double(shutterTime(0u, hashPixel(uvec2(x, 7), 0u, 1u))) - 0.5;
        covariance += a * b / 4096.0;
    }
    // Standard deviation 1 / 12 / 64.
    EXPECT_NEAR(covariance, 0.0, 5.0 / 12.0 / 64.0);
}

TEST(SobolPoint, TheFirstPointsAreThePublishedOnes) {
    // Joe and Kuo 2008, "new-joe-kuo-6": eighths of the first three dimensions.
    const uvec3 expected[8] = {
        {0, 0, 0}, {4, 4, 4}, {2, 6, 6}, {6, 2, 2}, {1, 5, 3}, {5, 1, 7}, {3, 3, 5}, {7, 7, 1}};
    for (uint i = 0; i < 8; ++i)
        EXPECT_EQ(sobolPoint(i) >> 29u, expected[i]) << i;
}

TEST(PixelPlace, WithTheTimeItFillsTheCubeEvenly) {
    // Elementary boxes of a net: whatever way the volume is cut into powers of two.
    for (const uint seed : {1u, 900u}) {
        for (int cut = 0; cut < 3; ++cut) {
            std::vector<int> cells(256, 0);
            for (uint i = 0; i < 256; ++i) {
                const vec2 place = pixelPlace(i, seed);
                ASSERT_TRUE(place.x >= 0.0f && place.x < 1.0f && place.y >= 0.0f && place.y < 1.0f);
                const float a = cut == 0 ? shutterTime(i, seed) : place.x;
                const float b = cut == 1 ? shutterTime(i, seed) : place.y;
                ++cells[size_t(a * 8.0f) * 8 + size_t(b * 8.0f)];
            }
            for (size_t cell = 0; cell < 64; ++cell)
                EXPECT_EQ(cells[cell], 4) << cut;
        }
    }
}

TEST(HashPixel, NeighboursSeedsAndStreamsDiffer) {
    std::set<uint> found;
    for (uint x = 0; x < 16; ++x)
        for (uint y = 0; y < 16; ++y)
            for (uint seed = 0; seed < 4; ++seed)
                for (uint stream = 0; stream < 2; ++stream)
                    found.insert(hashPixel(uvec2(x, y), seed, stream));
    EXPECT_EQ(found.size(), 16u * 16u * 4u * 2u);
}

} // namespace shutter::shader
