// SPDX-License-Identifier: MIT
#include "shaders/motion_blur/weights.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace shutter::shader {

namespace {

double clamp01(double x) {
    return std::clamp(x, 0.0, 1.0);
}

/// McGuire 2012, section 3.2: cone(X, Y, v) = clamp(1 - |X - Y| / |v|, 0, 1).
double coneByThePaper(double distance, double speed) {
    return clamp01(1.0 - distance / speed);
}

/// cylinder(X, Y, v) = 1.0 - smoothstep(0.95 |v|, 1.05 |v|, |X - Y|).
double cylinderByThePaper(double distance, double speed) {
    const double t = clamp01((distance - 0.95 * speed) / (1.05 * speed - 0.95 * speed));
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

} // namespace

TEST(Weights, ConeAndCylinderAreThePapers) {
    for (const float speed : {0.5f, 1.0f, 7.3f, 40.0f, 32768.0f})
        for (int i = 0; i <= 60; ++i) {
            const float distance = speed * float(i) / 50.0f;
            EXPECT_NEAR(cone(distance, speed), coneByThePaper(distance, speed), 1e-5);
            EXPECT_NEAR(cylinder(distance, speed), cylinderByThePaper(distance, speed), 1e-4);
        }
}

TEST(Weights, AStillPixelSpreadsNowhere) {
    EXPECT_EQ(cone(1.0f, 0.0f), 0.0f);
    EXPECT_EQ(cylinder(1.0f, 0.0f), 0.0f);
    EXPECT_EQ(cone(0.0f, 0.0f), 1.0f); // at its own place it is there
    EXPECT_EQ(cylinder(0.0f, 0.0f), 1.0f);
}

TEST(Weights, ASampleInFrontCountsByItsOwnMotion) {
    // The target is still and lies deeper by not quite the whole extent.
    EXPECT_NEAR(sampleWeight(0.999f, 4.0f, 10.0f, 0.0f, 30.0f), coneByThePaper(4.0, 10.0), 1e-5);
    // A still sample in front covers nothing but its own place.
    EXPECT_EQ(sampleWeight(2.0f, 4.0f, 0.0f, 10.0f, 30.0f), 0.0f);
}

TEST(Weights, MagnificationActsOnlyWhereTheTargetIsDeeperByTheWholeExtent) {
    const float plain = sampleWeight(1.0f, 4.0f, 10.0f, 0.0f, 1.0f);
    EXPECT_NEAR(sampleWeight(1.0f, 4.0f, 10.0f, 0.0f, 30.0f), 30.0f * plain, 1e-4f);
    EXPECT_EQ(
        sampleWeight(0.99f, 4.0f, 10.0f, 0.0f, 30.0f), sampleWeight(0.99f, 4.0f, 10.0f, 0.0f, 1.0f)
    );
    EXPECT_EQ(
        sampleWeight(-1.0f, 4.0f, 10.0f, 8.0f, 30.0f), sampleWeight(-1.0f, 4.0f, 10.0f, 8.0f, 1.0f)
    );
}

TEST(Weights, ASampleBehindCountsByTheTargetsMotion) {
    const float weight = sampleWeight(-1.0f, 4.0f, 0.0f, 10.0f, 30.0f);
    EXPECT_NEAR(weight, coneByThePaper(4.0, 10.0), 1e-5);
    EXPECT_EQ(sampleWeight(-1.0f, 4.0f, 3.0f, 0.0f, 30.0f), 0.0f);
}

TEST(Weights, TwoThatMoveTogetherBlurEachOther) {
    // z = 0: both cones and twice both cylinders.
    const double expected = coneByThePaper(4.0, 10.0) + coneByThePaper(4.0, 8.0) +
                            2.0 * cylinderByThePaper(4.0, 10.0) * cylinderByThePaper(4.0, 8.0);
    EXPECT_NEAR(sampleWeight(0.0f, 4.0f, 10.0f, 8.0f, 30.0f), expected, 1e-5);
}

TEST(Weights, NoWeightIsNegativeOrInfinite) {
    for (const float z : {-1e9f, -1.0f, 0.0f, 0.5f, 1.0f, 1e9f})
        for (const float distance : {0.0f, 0.5f, 39.0f, 1e6f})
            for (const float sample : {0.0f, 0.5f, 32768.0f})
                for (const float target : {0.0f, 0.5f, 32768.0f}) {
                    const float weight = sampleWeight(z, distance, sample, target, 30.0f);
                    EXPECT_TRUE(weight >= 0.0f && isFinite(weight));
                }
}

TEST(Weights, TheCentreCountsOneOverItsSpeedButAStillOneIsBounded) {
    EXPECT_FLOAT_EQ(centreWeight(10.0f), 0.1f);
    EXPECT_FLOAT_EQ(centreWeight(0.0f), 2.0f);
}

TEST(Weights, TheNoiseIsSpreadEvenlyOverZeroToOne) {
    constexpr int kSide = 64;
    std::vector<int> histogram(8, 0);
    double sum = 0.0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const float noise = interleavedGradientNoise(vec2(float(x), float(y)) + 0.5f);
            ASSERT_TRUE(noise >= 0.0f && noise < 1.0f);
            sum += double(noise);
            ++histogram[size_t(noise * 8.0f)];
        }
    EXPECT_NEAR(sum / (kSide * kSide), 0.5, 0.01);
    for (const int count : histogram)
        EXPECT_NEAR(count, kSide * kSide / 8, kSide * kSide / 80);
}

TEST(Weights, TheLongerMotionWins) {
    EXPECT_EQ(longerMotion(vec2(3.0f, 4.0f), vec2(0.0f, 4.9f)), vec2(3.0f, 4.0f));
    EXPECT_EQ(longerMotion(vec2(0.0f), vec2(0.0f, -1.0f)), vec2(0.0f, -1.0f));
}

TEST(Weights, AmongEquallyLongMotionsTheOrderDoesNotMatter) {
    const std::vector<vec2> motions = {{3, 4}, {-3, 4}, {4, 3}, {0, 5}, {-5, 0}, {5, 0}, {3, -4}};
    for (const vec2 a : motions)
        for (const vec2 b : motions)
            EXPECT_EQ(longerMotion(a, b), longerMotion(b, a));
    EXPECT_EQ(longerMotion(vec2(3, 4), vec2(3, -4)), vec2(3, 4));
    EXPECT_EQ(longerMotion(vec2(3, 4), vec2(4, 3)), vec2(4, 3));
}

TEST(Weights, TheTileOfAPixelIsExactUpToTheLargestPicture) {
    constexpr uint kLongest = 16384;
    for (uint tile = 1; tile <= 256; ++tile) {
        const uvec2 count((kLongest + tile - 1) / tile);
        for (uint pixel = 0; pixel < kLongest; ++pixel) {
            // A nearest sampler finds the texel whose span holds the coordinate.
            const float texel = tileUv(vec2(float(pixel) + 0.5f), tile, count).x * float(count.x);
            ASSERT_EQ(uint(texel), pixel / tile) << pixel << " " << tile;
        }
    }
}

TEST(Weights, AMotionIsCutToTheLimitAndKeepsItsDirection) {
    EXPECT_EQ(clampMotion(vec2(3.0f, 4.0f), 5.0f), vec2(3.0f, 4.0f));
    EXPECT_EQ(clampMotion(vec2(0.0f), 5.0f), vec2(0.0f));
    const vec2 cut = clampMotion(vec2(-30.0f, 40.0f), 5.0f);
    EXPECT_NEAR(cut.x, -3.0f, 1e-5f);
    EXPECT_NEAR(cut.y, 4.0f, 1e-5f);
}

} // namespace shutter::shader
