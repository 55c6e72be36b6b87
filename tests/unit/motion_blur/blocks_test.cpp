// SPDX-License-Identifier: MIT
// Active blocks, their traced pixels, and the use of their rays.
#include "shaders/motion_blur/block_class.glsl"
#include "shaders/motion_blur/denoise.glsl"
#include "shaders/motion_blur/jump.glsl"
#include "shaders/motion_blur/mask_bits.glsl"
#include "shaders/motion_blur/missing_taps.glsl"
#include "shaders/motion_blur/ray_mask.glsl"
#include "shaders/motion_blur/ray_share.glsl"
#include "shaders/motion_blur/weights.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>

namespace shutter::shader {
namespace {

constexpr float kSoft = 0.03f;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(BlockClass, ATilesClassFollowsFromItsMotionItsDeviationAndItsDepths) {
    EXPECT_EQ(classifyTile(40.0f, 0.5f, 1e9f, 0.5f, kSoft), kClassUniform);
    EXPECT_EQ(classifyTile(40.0f, 0.51f, 1e9f, 0.5f, kSoft), kClassDeep);
    EXPECT_EQ(classifyTile(1.6f, 0.1f, 1e9f, 0.5f, kSoft), kClassUniform);
    EXPECT_EQ(classifyTile(1.6f, 0.11f, 1e9f, 0.5f, kSoft), kClassDeep);
    for (const float deviation : {0.0f, 0.4f, 1e9f, kNan})
        for (const float depth : {0.0f, 1e9f})
            EXPECT_EQ(classifyTile(0.49f, deviation, depth, 0.5f, kSoft), kClassStill);
    EXPECT_EQ(classifyTile(40.0f, 0.0f, 1e9f, 0.0f, kSoft), kClassDeep);
    EXPECT_EQ(classifyTile(40.0f, kNan, 1e9f, 0.5f, kSoft), kClassDeep);
    EXPECT_EQ(classifyTile(40.0f, kInfinity, 1e9f, 0.5f, kSoft), kClassDeep);
    EXPECT_EQ(classifyTile(40.0f, 9.0f, kSoft, 0.5f, kSoft), kClassMixed);
    EXPECT_EQ(classifyTile(40.0f, 9.0f, 1.01f * kSoft, 0.5f, kSoft), kClassDeep);
    // All moves by 100 px: taps go 40 px far, but weights are of 100.
    EXPECT_GE(tileSpread({100, 0}, {100, 0}, 100.0f, 40.0f), 60.0f);
    EXPECT_EQ(tileSpread({30, 0}, {30, 0}, 30.0f, 40.0f), 0.0f);
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

TEST(BlockClass, ASmearReachesBlocksWithinItsLength) {
    const auto reaches = [](float x, float y, float reach) {
        return reachesBlock({x, y}, {x + 8, y + 8}, {40, 40}, {80, 80}, reach);
    };
    EXPECT_TRUE(reaches(48, 48, 0.5f)) << "inside";
    EXPECT_TRUE(reaches(80, 40, 0.0f)) << "adjacent";
    EXPECT_TRUE(reaches(90, 40, 9.5f));
    EXPECT_FALSE(reaches(90, 40, 8.5f));
    EXPECT_TRUE(reaches(20, 40, 11.5f)) << "the block ends at 28";
    EXPECT_FALSE(reaches(20, 40, 10.5f));
    EXPECT_FALSE(reaches(90, 90, 12.0f)) << "across a corner it is farther";
    EXPECT_TRUE(reaches(90, 90, 13.5f));
}

TEST(BlockTiles, ACentreLiesInTheTileOfWholeNumbersAndPositionsBeyondThePictureInTheNearest) {
    for (uint tileSize = 1; tileSize < 130; ++tileSize)
        for (uint x = 0; x < 8192; ++x)
            ASSERT_EQ(
                tileAt(vec2(float(x) + 0.5f, 0.5f), tileSize, uvec2(10000, 1)),
                ivec2(x / tileSize, 0)
            ) << x
              << " of " << tileSize;
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

TEST(ShownMotion, MotionBeyondTheDepthLimitOrNotFiniteIsShownAsNone) {
    EXPECT_EQ(shownMotion({3, 4}, 10.0f, 10.0f), vec2(3, 4));
    EXPECT_EQ(shownMotion({3, 4}, 10.1f, 10.0f), vec2(0));
    EXPECT_EQ(shownMotion({3, 4}, 1e9f, kInfinity), vec2(3, 4)) << "no limit: the sky too";
    EXPECT_EQ(shownMotion({3, 4}, 1e9f, 1e6f), vec2(0));
    EXPECT_EQ(shownMotion({3, 4}, kNan, kInfinity), vec2(0));
    for (const float bad : {kNan, kInfinity, -kInfinity, 3e38f}) {
        EXPECT_EQ(shownMotion({bad, 0}, 1.0f, kInfinity), vec2(0));
        EXPECT_EQ(limitMotion({0, bad, 1}, 40.0f, kInfinity), vec2(0));
    }
    EXPECT_FLOAT_EQ(limitMotion({80, 0, 1}, 40.0f, kInfinity).x, 40.0f);
    EXPECT_EQ(limitMotion({80, 0, 1}, 40.0f, kInfinity).y, 0.0f);
    EXPECT_EQ(limitMotion({80, 0, 2}, 40.0f, 1.0f), vec2(0));
}

TEST(UniformWeight, TheUniformWeightIsThatOfEqualMotionAtOneDepth) {
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

bool isMasked(uvec2 bits, uint x, uint y) {
    return hasBit(bits, x + 8 * y);
}

/// By the definition: masked, and no pixel of its quad before it is.
bool leads(uvec2 bits, uint x, uint y) {
    for (uint i = 0; i < x % 2 + y % 2 * 2; ++i)
        if (isMasked(bits, x - x % 2 + i % 2, y - y % 2 + i / 2))
            return false;
    return isMasked(bits, x, y);
}

/// Blocks of many densities.
template <class Check> void forBlocks(Check&& check) {
    std::mt19937 random(3);
    for (int i = 0; i < 300; ++i) {
        uvec2 bits(random(), random());
        for (int thin = 0; thin < i % 4; ++thin)
            bits &= uvec2(random(), random());
        check(i == 0 ? uvec2(0u) : i == 1 ? uvec2(~0u) : bits);
    }
}

TEST(MaskBits, TheFirstMaskedPixelOfAQuadLeadsItAndAllAreListedWithoutQuads) {
    forBlocks([](uvec2 bits) {
        const uvec2 listed = listedBits(bits, true);
        for (uint y = 0; y < 8; ++y)
            for (uint x = 0; x < 8; ++x)
                ASSERT_EQ(isMasked(listed, x, y), leads(bits, x, y)) << x << ", " << y;
    });
    forBlocks([](uvec2 bits) { ASSERT_EQ(listedBits(bits, false), bits); });
}

TEST(MaskBits, ThreadsTakeThePlacesInTurnAndRowsBeginAtTheirFirstEntry) {
    forBlocks([](uvec2 bits) {
        uint place = 0;
        for (uint thread = 0; thread < 64; ++thread) {
            ASSERT_EQ(countBitsBefore(bits, thread), place) << thread;
            place += hasBit(bits, thread) ? 1 : 0;
        }
        ASSERT_EQ(countBits(bits), place);
    });
    EXPECT_EQ(countRows(0, 4), 0u);
    EXPECT_EQ(countRows(1, 4), 1u);
    EXPECT_EQ(countRows(4, 4), 1u);
    EXPECT_EQ(countRows(5, 4), 2u);
}

/// Horizontal response of the operator to values f(x, y) around a pixel.
template <class F> float respond(F&& f) {
    float sum = 0.0f;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x)
            sum += sobelDerive(x) * sobelSmooth(y) * f(x, y);
    return sum;
}

TEST(MissingTaps, EachTapHasABitOfAWordAndEachBitStandsForATapOfItsOwn) {
    for (uint32_t tapCount = 1; tapCount <= 256; ++tapCount)
        for (uint32_t tap = 0; tap < tapCount; ++tap) {
            const uint32_t bit = bitOfTap(tap, tapCount);
            ASSERT_LT(bit, 32u);
            ASSERT_LT(tapOfBit(bit, tapCount), tapCount);
            ASSERT_EQ(bitOfTap(tapOfBit(bit, tapCount), tapCount), bit);
            if (tapCount <= 32) {
                ASSERT_EQ(tapOfBit(bit, tapCount), tap);
            }
        }
}

TEST(Jumps, MarksOrderByDepthHoldAPlaceAndAreNeverNone) {
    const float depths[] = {0.0f, 1e-30f, 0.1f, 1.0f, 1.001f, 1e9f, 3.0e38f};
    const ivec2 first(kFirstPlace);
    const ivec2 last = first + int(kPlaceMask);
    for (size_t i = 1; i < std::size(depths); ++i)
        EXPECT_GT(markJump(depths[i - 1], first), markJump(depths[i], last));
    for (const float depth : depths)
        for (const ivec2 place : {first, ivec2(0), ivec2(3, -5), last}) {
            const uint32_t mark = markJump(depth, place);
            EXPECT_NE(mark, kNoJump);
            EXPECT_EQ(placeOfJump(mark), place);
            EXPECT_LE(depthOfJump(mark), depth);
            EXPECT_GE(depthOfJump(mark), depth * (1.0f - 1.0f / 4096.0f) - 1e-30f);
        }
    EXPECT_NE(markJump(kInfinity, first), kNoJump);
    EXPECT_NE(markJump(-1.0f, first), kNoJump);
    EXPECT_NE(markJump(kNan, first), kNoJump);
    // The place fits for every block that a jump marks.
    const int reach = int(kJumpReachPx);
    const int size = int(kGroupSize);
    EXPECT_GE(-reach, kFirstPlace);
    EXPECT_LE(size - 1 + reach, last.x);
}

TEST(Jumps, NoStepAlongAMotionIsLongerThanWhatAMarkReaches) {
    for (float length = 0.0f; length <= kJumpStepPx * kMaxJumpSteps; length += 0.7f)
        EXPECT_LE(length / countJumpSteps({length, 0.0f}), kJumpStepPx) << length;
    EXPECT_EQ(countJumpSteps({1e30f, 1e30f}), kMaxJumpSteps);
    EXPECT_FALSE(moveApart({5.0f, 0.0f}, {5.2f, 0.0f}));
    EXPECT_TRUE(moveApart({5.0f, 0.0f}, {5.0f, 0.3f}));
}

TEST(RayMask, TheOperatorIsTheSeparableFiveByFiveSobelWhichAnswersASlopeByItsSteepness) {
    // Rows of Pascal's triangle: the smoothing part is (1 1)^4, the derivative (1 1)^3 (-1 1).
    const std::array smooth{1.0f, 4.0f, 6.0f, 4.0f, 1.0f};
    const std::array derive{-1.0f, -2.0f, 0.0f, 2.0f, 1.0f};
    for (int offset = -2; offset <= 2; ++offset) {
        EXPECT_EQ(sobelSmooth(offset), smooth[size_t(offset + 2)]);
        EXPECT_EQ(sobelDerive(offset), derive[size_t(offset + 2)]);
    }
    EXPECT_EQ(respond([](int, int) { return 7.0f; }), 0.0f);
    EXPECT_EQ(respond([](int, int y) { return float(y); }), 0.0f);
    const float slope = respond([](int x, int) { return float(x); });
    EXPECT_GT(slope, 0.0f);
    EXPECT_EQ(respond([](int x, int) { return -3.0f * float(x); }), -3.0f * slope);
}

TEST(RayMask, TheMeasureIsOneMinusOneOverXPlusOneAndGrowsWithTheEdge) {
    // x = |depth| + |normal| = 5 + 3.
    const vec3 across(1.0f, 2.0f, 0.0f);
    const vec3 down(0.0f, 0.0f, -2.0f);
    EXPECT_NEAR(edgeMeasure(vec2(3.0f, -4.0f), across, down), 1.0f - 1.0f / 9.0f, 1e-6f);
    EXPECT_NEAR(edgeMeasure(vec2(1.0f, 0.0f), vec3(0.0f), vec3(0.0f)), 0.5f, 1e-6f);
    EXPECT_NEAR(edgeMeasure(vec2(0.0f), vec3(0.0f), vec3(0.0f, 9.0f, 0.0f)), 0.9f, 1e-6f);
    float last = 0.0f;
    for (float x = 0.001f; x < 1e5f; x *= 2.0f) {
        const float measure = edgeMeasure(vec2(0.0f, x), vec3(0.0f), vec3(0.0f));
        EXPECT_GT(measure, last);
        EXPECT_LT(measure, 1.0f);
        last = measure;
    }
    // The sky's depth next to a near surface.
    EXPECT_LE(edgeMeasure(vec2(48.0e9f, 0.0f), vec3(0.0f), vec3(0.0f)), 1.0f);
}

constexpr int kSide = 240;

/// Rays over all blocks where every pixel is masked, of as many pixels.
double traceEverything(float rayShare) {
    double rays = 0.0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const uint32_t tracing = chooseTracing({float(x), float(y)}, rayShare);
            rays += tracing == kTracePixels ? 1.0 : tracing == kTraceQuads ? kQuadShare : 0.0;
        }
    return rays / (kSide * kSide);
}

TEST(RayShare, AllBlocksTogetherTraceTheShareAndOfOneEveryPixel) {
    for (const float share : {0.0f, 0.01f, 0.1f, 0.25f, 0.26f, 0.5f, 0.75f, 0.99f, 1.0f})
        EXPECT_NEAR(traceEverything(share), share, 0.01) << share;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            ASSERT_EQ(chooseTracing({float(x), float(y)}, 1.0f), kTracePixels);
            ASSERT_EQ(chooseTracing({float(x), float(y)}, 0.0f), kTraceNothing);
        }
}

TEST(RayShare, ALargerShareTakesNothingFromAnyBlock) {
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x)
            for (int i = 0; i < 20; ++i) // kTracePixels is the least number
                ASSERT_GE(
                    chooseTracing({float(x), float(y)}, float(i) / 20.0f),
                    chooseTracing({float(x), float(y)}, float(i + 1) / 20.0f)
                );
}

TEST(Denoise, TheDeviationOfAMeanIsThatOfItsValuesAndZeroOfFewOrEqualOnes) {
    // 1, 2, 3, 4, 5: variance 2.5.
    EXPECT_NEAR(deviationOfMean(15.0f, 55.0f, 5), std::sqrt(2.5f) / 5.0f, 1e-6f);
    EXPECT_EQ(deviationOfMean(20.0f, 100.0f, 4), 0.0f); // all 5
    EXPECT_EQ(deviationOfMean(0.0f, 0.0f, 0), 0.0f);
    EXPECT_EQ(deviationOfMean(1.0f, 1.0f, 1), 0.0f);
    EXPECT_EQ(deviationOfMean(6.0f, 20.0f, 3), 0.0f);
    // The squares' sum is a little too small, as rounding leaves it.
    EXPECT_EQ(deviationOfMean(4000.0f, 3999999.5f, 4), 0.0f);
}

TEST(Denoise, TheKernelsWeightsSumToOneAndALevelStaysWithinHalfTheSmear) {
    float sum = 0.0f;
    for (int k = -2; k <= 2; ++k) {
        EXPECT_EQ(atrousWeight(k), atrousWeight(-k));
        sum += atrousWeight(k);
    }
    EXPECT_EQ(sum, 1.0f);
    EXPECT_TRUE(levelFits(1.0f, 4.0f));
    EXPECT_FALSE(levelFits(1.0f, 3.9f));
    EXPECT_TRUE(levelFits(16.0f, 64.0f));
    EXPECT_FALSE(levelFits(16.0f, 40.0f));
    EXPECT_FALSE(levelFits(1.0f, 0.0f));
}

TEST(Denoise, EqualLightAlwaysCountsAndNoiseFreePixelsTakeNothingElse) {
    EXPECT_FLOAT_EQ(luminanceWeight(0.0f, 0.0f, 4.0f), 1.0f);
    EXPECT_FLOAT_EQ(luminanceWeight(0.0f, 0.3f, 4.0f), 1.0f);
    EXPECT_LT(luminanceWeight(0.01f, 0.0f, 4.0f), 1e-30f);
    EXPECT_GT(luminanceWeight(-0.01f, 0.1f, 4.0f), 0.97f);
    EXPECT_EQ(luminanceWeight(-0.5f, 0.1f, 4.0f), luminanceWeight(0.5f, 0.1f, 4.0f));
    EXPECT_EQ(luminanceWeight(65000.0f, 0.0f, 0.01f), 0.0f);
}

} // namespace
} // namespace shutter::shader
