// SPDX-License-Identifier: MIT
#include "shaders/motion_blur/block_class.glsl"
#include "shaders/motion_blur/weights.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace shutter::shader {

namespace {

constexpr float kSoft = 0.03f;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

} // namespace

TEST(BlockClass, BelowHalfAPixelATileIsStillWhateverElseItIs) {
    for (const float deviation : {0.0f, 0.4f, 1e9f, kNan})
        for (const float depth : {0.0f, 1e9f})
            EXPECT_EQ(classifyTile(0.49f, deviation, depth, 0.5f, kSoft), kClassStill);
}

TEST(BlockClass, UniformIsWithinHalfAPixelAndASixteenthOfTheMotion) {
    EXPECT_EQ(classifyTile(40.0f, 0.5f, 1e9f, 0.5f, kSoft), kClassUniform);
    EXPECT_EQ(classifyTile(40.0f, 0.51f, 1e9f, 0.5f, kSoft), kClassDeep);
    EXPECT_EQ(classifyTile(1.6f, 0.1f, 1e9f, 0.5f, kSoft), kClassUniform);
    EXPECT_EQ(classifyTile(1.6f, 0.11f, 1e9f, 0.5f, kSoft), kClassDeep);
}

TEST(BlockClass, ZeroTurnsUniformMotionOff) {
    EXPECT_EQ(classifyTile(40.0f, 0.0f, 1e9f, 0.0f, kSoft), kClassDeep);
}

TEST(BlockClass, ADeviationThatIsNoNumberIsNotUniform) {
    EXPECT_EQ(classifyTile(40.0f, kNan, 1e9f, 0.5f, kSoft), kClassDeep);
    EXPECT_EQ(classifyTile(40.0f, kInfinity, 1e9f, 0.5f, kSoft), kClassDeep);
}

TEST(BlockClass, NothingCanBeRevealedWhereDepthsDifferByNoMoreThanTheSoftExtent) {
    EXPECT_EQ(classifyTile(40.0f, 9.0f, kSoft, 0.5f, kSoft), kClassMixed);
    EXPECT_EQ(classifyTile(40.0f, 9.0f, 1.01f * kSoft, 0.5f, kSoft), kClassDeep);
}

TEST(BlockClass, TheSpreadBoundsEveryMotionsDistanceFromTheLongest) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> component(-30.0f, 30.0f);
    for (int round = 0; round < 200; ++round) {
        constexpr float kLimit = 20.0f;
        vec2 motions[7];
        vec2 longest(0.0f);
        vec2 least(1e9f);
        vec2 greatest(-1e9f);
        for (vec2& motion : motions) {
            motion = {component(random), component(random)};
            longest = longerMotion(longest, motion);
            least = min(least, motion);
            greatest = max(greatest, motion);
        }
        const float spread = tileSpread(least, greatest, length(longest), kLimit);
        for (const vec2& motion : motions)
            EXPECT_LE(length(motion - clampMotion(longest, kLimit)), spread + 1e-4f);
    }
}

TEST(BlockClass, MotionCutToTheTileIsNotUniform) {
    // All moves by 100 px: taps go 40 px far, but weights are of 100.
    EXPECT_GE(tileSpread({100, 0}, {100, 0}, 100.0f, 40.0f), 60.0f);
    EXPECT_EQ(tileSpread({30, 0}, {30, 0}, 30.0f, 40.0f), 0.0f);
}

TEST(BlockClass, ASmearReachesBlocksWithinItsLength) {
    const auto reaches = [](float x, float y, float reach) {
        return reachesBlock({x, y}, {x + 8, y + 8}, {40, 40}, {80, 80}, reach);
    };
    EXPECT_TRUE(reaches(48, 48, 0.5f)) << "inside";
    EXPECT_TRUE(reaches(80, 40, 0.0f)) << "beside";
    EXPECT_TRUE(reaches(90, 40, 9.5f));
    EXPECT_FALSE(reaches(90, 40, 8.5f));
    EXPECT_TRUE(reaches(20, 40, 11.5f)) << "the block ends at 28";
    EXPECT_FALSE(reaches(20, 40, 10.5f));
    EXPECT_FALSE(reaches(90, 90, 12.0f)) << "across a corner it is farther";
    EXPECT_TRUE(reaches(90, 90, 13.5f));
}

TEST(BlockTiles, ACentreLiesInTheTileThatWholeNumbersSay) {
    for (uint tileSize = 1; tileSize < 130; ++tileSize)
        for (uint x = 0; x < 8192; ++x)
            ASSERT_EQ(
                tileAt(vec2(float(x) + 0.5f, 0.5f), tileSize, uvec2(10000, 1)),
                ivec2(x / tileSize, 0)
            ) << x
              << " of " << tileSize;
}

TEST(BlockTiles, PositionsBeyondThePictureLieInItsNearestTile) {
    EXPECT_EQ(tileAt(vec2(-7.0f, 95.0f), 10, uvec2(3, 4)), ivec2(0, 3));
    EXPECT_EQ(lowestTile(vec2(0.0f), 5.0f, 10, uvec2(3, 4)), ivec2(0));
    EXPECT_EQ(highestTile(vec2(30.0f, 40.0f), 5.0f, 10, uvec2(3, 4)), ivec2(2, 3));
}

TEST(BlockTiles, ABlockKnowsEveryTileThatItsPixelsLookUp) {
    constexpr uint kBlock = 8;
    const uvec2 tiles(10000, 1);
    for (uint tileSize = 2; tileSize < 130; ++tileSize)
        for (const float margin : {0.0f, 0.25f * float(tileSize), 1.5f})
            for (uint block = 0; block < 512; ++block) {
                const vec2 first(float(block * kBlock), 0.0f);
                const vec2 end = first + vec2(float(kBlock), 1.0f);
                const int lowest = lowestTile(first, margin, tileSize, tiles).x;
                const int highest = highestTile(end, margin, tileSize, tiles).x;
                for (const float centre : {first.x + 0.5f, end.x - 0.5f})
                    for (const float side : {-margin, 0.0f, margin}) {
                        const double at = double(centre + side);
                        const int tile = std::max(int(std::floor(at / double(tileSize))), 0);
                        ASSERT_LE(lowest, tile) << block << ", margin " << margin;
                        ASSERT_GE(highest, tile) << block << ", margin " << margin;
                    }
                // No more than that: a tile too many would make still blocks work.
                ASSERT_GE((float(lowest) + 1.0f) * float(tileSize), first.x - margin);
                ASSERT_LE(float(highest) * float(tileSize), end.x + margin);
            }
}

TEST(ShownMotion, MotionEndsBeyondTheDepthLimit) {
    EXPECT_EQ(shownMotion({3, 4}, 10.0f, 10.0f), vec2(3, 4));
    EXPECT_EQ(shownMotion({3, 4}, 10.1f, 10.0f), vec2(0));
    EXPECT_EQ(shownMotion({3, 4}, 1e9f, kInfinity), vec2(3, 4)) << "no limit: the sky too";
    EXPECT_EQ(shownMotion({3, 4}, 1e9f, 1e6f), vec2(0));
    EXPECT_EQ(shownMotion({3, 4}, kNan, kInfinity), vec2(0));
}

TEST(ShownMotion, WhatIsNotFiniteIsNone) {
    for (const float bad : {kNan, kInfinity, -kInfinity, 3e38f}) {
        EXPECT_EQ(shownMotion({bad, 0}, 1.0f, kInfinity), vec2(0));
        EXPECT_EQ(limitMotion({0, bad, 1}, 40.0f, kInfinity), vec2(0));
    }
    EXPECT_FLOAT_EQ(limitMotion({80, 0, 1}, 40.0f, kInfinity).x, 40.0f);
    EXPECT_EQ(limitMotion({80, 0, 1}, 40.0f, kInfinity).y, 0.0f);
    EXPECT_EQ(limitMotion({80, 0, 2}, 40.0f, 1.0f), vec2(0));
}

TEST(UniformWeight, IsTheFullWeightOfTwoThatMoveAlikeAtOneDepth) {
    for (const float speed : {0.5f, 3.0f, 40.0f})
        for (int i = 0; i <= 50; ++i) {
            const float distance = speed * 1.2f * float(i) / 50.0f;
            EXPECT_NEAR(
                uniformWeight(smearRatio(distance, speed)),
                sampleWeight(0.0f, distance, speed, speed, 30.0f),
                1e-6f
            );
        }
}

} // namespace shutter::shader
