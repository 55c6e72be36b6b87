// SPDX-License-Identifier: MIT
// Taps and weights of the filters, against the papers' formulas.
#include "shaders/motion_blur/guertin2014.glsl"
#include "shaders/motion_blur/jimenez2014.glsl"
#include "shaders/motion_blur/own_velocity.glsl"
#include "shaders/motion_blur/taps.glsl"
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

TEST(Weights, ConeAndCylinderAreThePapersAndAStillPixelSpreadsNowhere) {
    for (const float speed : {0.5f, 1.0f, 7.3f, 40.0f, 32768.0f})
        for (int i = 0; i <= 60; ++i) {
            const float distance = speed * float(i) / 50.0f;
            EXPECT_NEAR(cone(distance, speed), coneByThePaper(distance, speed), 1e-5);
            EXPECT_NEAR(cylinder(distance, speed), cylinderByThePaper(distance, speed), 1e-4);
        }
    EXPECT_EQ(cone(1.0f, 0.0f), 0.0f);
    EXPECT_EQ(cylinder(1.0f, 0.0f), 0.0f);
    EXPECT_EQ(cone(0.0f, 0.0f), 1.0f); // at its own place it is there
    EXPECT_EQ(cylinder(0.0f, 0.0f), 1.0f);
}

TEST(Weights, ASampleInFrontCountsByItsOwnMotionOneBehindByTheTargetsAndEqualsByBoth) {
    // The target is still and lies deeper by not quite the whole extent.
    EXPECT_NEAR(sampleWeight(0.999f, 4.0f, 10.0f, 0.0f, 30.0f), coneByThePaper(4.0, 10.0), 1e-5);
    // A still sample in front covers nothing but its own place.
    EXPECT_EQ(sampleWeight(2.0f, 4.0f, 0.0f, 10.0f, 30.0f), 0.0f);
    const float weight = sampleWeight(-1.0f, 4.0f, 0.0f, 10.0f, 30.0f);
    EXPECT_NEAR(weight, coneByThePaper(4.0, 10.0), 1e-5);
    EXPECT_EQ(sampleWeight(-1.0f, 4.0f, 3.0f, 0.0f, 30.0f), 0.0f);
    // z = 0: both cones and twice both cylinders.
    const double expected = coneByThePaper(4.0, 10.0) + coneByThePaper(4.0, 8.0) +
                            2.0 * cylinderByThePaper(4.0, 10.0) * cylinderByThePaper(4.0, 8.0);
    EXPECT_NEAR(sampleWeight(0.0f, 4.0f, 10.0f, 8.0f, 30.0f), expected, 1e-5);
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

TEST(Weights, NoWeightIsNegativeOrInfiniteAndTheCentreCountsOneOverItsSpeed) {
    for (const float z : {-1e9f, -1.0f, 0.0f, 0.5f, 1.0f, 1e9f})
        for (const float distance : {0.0f, 0.5f, 39.0f, 1e6f})
            for (const float sample : {0.0f, 0.5f, 32768.0f})
                for (const float target : {0.0f, 0.5f, 32768.0f}) {
                    const float weight = sampleWeight(z, distance, sample, target, 30.0f);
                    EXPECT_TRUE(weight >= 0.0f && isFinite(weight));
                }
    EXPECT_FLOAT_EQ(centreWeight(10.0f), 0.1f);
    EXPECT_FLOAT_EQ(centreWeight(0.0f), 2.0f);
}

TEST(Weights, TheNoiseIsSpreadEvenlyOverZeroToOne) {
    constexpr int kGrid = 64;
    std::vector<int> histogram(8, 0);
    double sum = 0.0;
    for (int y = 0; y < kGrid; ++y)
        for (int x = 0; x < kGrid; ++x) {
            const float noise = interleavedGradientNoise(vec2(float(x), float(y)) + 0.5f);
            ASSERT_TRUE(noise >= 0.0f && noise < 1.0f);
            sum += double(noise);
            ++histogram[size_t(noise * 8.0f)];
        }
    EXPECT_NEAR(sum / (kGrid * kGrid), 0.5, 0.01);
    for (const int count : histogram)
        EXPECT_NEAR(count, kGrid * kGrid / 8, kGrid * kGrid / 80);
}

TEST(Weights, TheLongestMotionDoesNotDependOnTheOrderAndIsCutAlongItsDirection) {
    const std::vector<vec2> motions = {{3, 4}, {-3, 4}, {4, 3}, {0, 5}, {-5, 0}, {5, 0}, {3, -4}};
    for (const vec2 a : motions)
        for (const vec2 b : motions)
            EXPECT_EQ(longerMotion(a, b), longerMotion(b, a));
    EXPECT_EQ(longerMotion(vec2(3, 4), vec2(3, -4)), vec2(3, 4));
    EXPECT_EQ(longerMotion(vec2(3, 4), vec2(4, 3)), vec2(4, 3));
    EXPECT_EQ(clampMotion(vec2(3.0f, 4.0f), 5.0f), vec2(3.0f, 4.0f));
    EXPECT_EQ(clampMotion(vec2(0.0f), 5.0f), vec2(0.0f));
    const vec2 cut = clampMotion(vec2(-30.0f, 40.0f), 5.0f);
    EXPECT_NEAR(cut.x, -3.0f, 1e-5f);
    EXPECT_NEAR(cut.y, 4.0f, 1e-5f);
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

constexpr float kShares[] = {0.0f, 0.5f, 1.0f};

/// Light that rises evenly from none at open: s = sqrt(u).
ResponseTable risingResponse() {
    ResponseTable table{};
    table.knotCount = 2;
    table.knots[0] = {0.0f, 0.0f, 0.0f, 0.0f};
    table.knots[1] = {1.0f, 2.0f, 1.0f, 0.0f};
    fillFirstKnots(table);
    return table;
}

TEST(Taps, TapsFillTheExposureEvenlyAndTheInnerOnesAreThePapers) {
    for (const float share : kShares)
        for (const uint count : {1u, 2u, 15u, 256u})
            for (uint i = 0; i < count; ++i) {
                const float u = tapPosition(i, 0.5f, count, share);
                EXPECT_NEAR(u, (double(i) + 0.5) / count + double(share) - 1.0, 1e-6);
                EXPECT_GE(tapPosition(i, 0.0f, count, share), share - 1.0f - 1e-6f);
                EXPECT_LE(tapPosition(i, 0.999f, count, share), share + 1e-6f);
            }
    // t = mix(-1, 1, (i + j + 1) / (S + 1)) of a half velocity, which is half the motion.
    for (const uint count : {1u, 15u, 35u})
        for (uint i = 0; i < count; ++i)
            for (const double j : {-0.5, 0.0, 0.4}) {
                const double t = -1.0 + 2.0 * (i + j + 1.0) / (count + 1.0);
                EXPECT_NEAR(innerTapPosition(i, float(j), count, 0.5f), 0.5 * t, 1e-6);
            }
}

TEST(Taps, TapsFollowTheResponse) {
    const ResponseTable table = risingResponse();
    for (const float share : kShares)
        for (uint i = 0; i < 16; ++i) {
            const float even = tapPosition(i, 0.5f, 16, share);
            // The surface at u was there at s = s_r - u.
            const double s = std::sqrt(double(share) - double(even));
            EXPECT_NEAR(warpTap({table}, even, share), double(share) - s, 1e-6);
        }
}

TEST(Taps, TheCentreTapIsTheOneThatLandsOnThePixel) {
    const ResponseTable table = risingResponse();
    for (const float share : kShares)
        EXPECT_NEAR(warpTap({table}, findCentreTap({table}, share), share), 0.0f, 1e-6f) << share;
    EXPECT_NEAR(findCentreTap({table}, 0.5f), 0.25f, 1e-6f); // a quarter of the light is before
}

TEST(Taps, ASmearReachesAsFarAsTheExposureOnItsSide) {
    const vec2 motion(6.0f, 8.0f);
    for (const float share : kShares) {
        EXPECT_FLOAT_EQ(smearReach(vec2(1.0f, 1.0f), motion, share), 10.0f * share);
        EXPECT_FLOAT_EQ(smearReach(vec2(-1.0f, -1.0f), motion, share), 10.0f * (1.0f - share));
        EXPECT_EQ(smearReach(vec2(1.0f, 1.0f), vec2(0.0f), share), 0.0f);
    }
}

TEST(Taps, TheTileJitterStaysWithinAQuarterAndNeverGoesDiagonally) {
    float least[2] = {0.0f, 0.0f};
    float most[2] = {0.0f, 0.0f};
    for (int i = 0; i < 1000; ++i) {
        const vec2 shift = tileJitter(float(i) / 1000.0f, 40.0f);
        EXPECT_TRUE(shift.x == 0.0f || shift.y == 0.0f);
        for (int axis = 0; axis < 2; ++axis) {
            least[axis] = std::min(least[axis], shift[axis]);
            most[axis] = std::max(most[axis], shift[axis]);
        }
    }
    for (int axis = 0; axis < 2; ++axis) {
        EXPECT_NEAR(least[axis], -10.0f, 0.1f);
        EXPECT_NEAR(most[axis], 10.0f, 0.1f);
    }
}

TEST(Taps, TheTileIsThePixelsOwnWithoutJitter) {
    for (uint pixel = 0; pixel < 100; ++pixel) {
        const vec2 centre(float(pixel) + 0.5f);
        EXPECT_EQ(
            jitteredTileUv(centre, 0.0f, 16, uvec2(7), uvec2(100)), tileUv(centre, 16, uvec2(7))
        );
    }
}

TEST(Taps, TheJitteredTileIsInThePictureAndAtMostOneAway) {
    constexpr uint kTiles = 7; // the last of 4 px
    bool moved = false;
    for (uint y = 0; y < 100; ++y)
        for (uint x = 0; x < 100; ++x) {
            const vec2 centre(float(x) + 0.5f, float(y) + 0.5f);
            const vec2 uv = jitteredTileUv(centre, 1.0f, 16, uvec2(kTiles), uvec2(100));
            const ivec2 tile(floor(uv * float(kTiles)));
            ASSERT_TRUE(tile.x >= 0 && tile.x < int(kTiles) && tile.y >= 0 && tile.y < int(kTiles));
            const ivec2 away = abs(tile - ivec2(int(x / 16), int(y / 16)));
            ASSERT_LE(away.x + away.y, 1) << x << ", " << y;
            moved = moved || away.x + away.y > 0;
        }
    EXPECT_TRUE(moved);
}

/// Bevy's comparison for a centred exposure: half the sample's motion, projected on the step, is no
/// shorter than the step.
bool couldCoverByBevy(vec2 step, vec2 motion) {
    const double distance = std::hypot(double(step.x), double(step.y));
    const double speed = std::hypot(double(motion.x), double(motion.y)) / 2.0;
    const double dotted = double(step.x) * motion.x + double(step.y) * motion.y;
    const double similarity = std::min(std::abs(dotted / (distance * speed * 2.0)), 1.0);
    return speed * similarity >= distance;
}

TEST(OwnVelocity, TheOccluderTestIsBevysInACentredExposure) {
    int covering = 0;
    for (int step = 1; step < 12; ++step)
        for (int x = -25; x <= 25; x += 3)
            for (int y = -25; y <= 25; y += 3) {
                const vec2 offset(float(step), 0.37f * float(step));
                const vec2 motion(float(x) + 0.25f, float(y) + 0.5f);
                const bool covers = couldCover(offset, motion, 0.5f);
                EXPECT_EQ(covers, couldCoverByBevy(offset, motion)) << step << " " << x << " " << y;
                covering += covers;
            }
    EXPECT_GT(covering, 100);
}

TEST(OwnVelocity, AnOccluderCoversOnTheSideOfTheExposureAndAStillOneOnlyItself) {
    EXPECT_FALSE(couldCover(vec2(0.5f, 0.0f), vec2(0.0f), 0.5f));
    EXPECT_TRUE(couldCover(vec2(0.0f), vec2(0.0f), 0.5f));
    // Ends at the raster instant: only motion towards the offset has passed the pixel.
    EXPECT_TRUE(couldCover(vec2(8.0f, 0.0f), vec2(9.0f, 0.0f), 1.0f));
    EXPECT_FALSE(couldCover(vec2(8.0f, 0.0f), vec2(-9.0f, 0.0f), 1.0f));
    EXPECT_FALSE(couldCover(vec2(8.0f, 0.0f), vec2(9.0f, 0.0f), 0.0f));
    EXPECT_TRUE(couldCover(vec2(8.0f, 0.0f), vec2(-9.0f, 0.0f), 0.0f));
}

TEST(Guertin2014, OnlyTilesWhoseLinePassesReachThisOne) {
    // Adjacent: any motion with a part along the axis, either way. On the diagonal: along it only.
    EXPECT_TRUE(reachesTile(ivec2(1, 0), vec2(0.1f, 9.0f)));
    EXPECT_TRUE(reachesTile(ivec2(1, 0), vec2(-0.1f, 9.0f)));
    EXPECT_FALSE(reachesTile(ivec2(1, 0), vec2(0.0f, 9.0f)));
    EXPECT_FALSE(reachesTile(ivec2(0, -1), vec2(9.0f, 0.0f)));
    EXPECT_TRUE(reachesTile(ivec2(-1, -1), vec2(-1.0f, -2.0f)));
    EXPECT_TRUE(reachesTile(ivec2(-1, -1), vec2(1.0f, 2.0f)));
    EXPECT_FALSE(reachesTile(ivec2(-1, -1), vec2(1.0f, -2.0f)));
    EXPECT_FALSE(reachesTile(ivec2(1, 1), vec2(5.0f, 0.0f)));
    EXPECT_TRUE(reachesTile(ivec2(0, 0), vec2(0.0f)));
    EXPECT_TRUE(reachesTile(ivec2(2, -2), vec2(3.0f, -3.0f)));
}

TEST(Guertin2014, AlignmentIsTheCosineAndStillIsAlignedWithNothing) {
    EXPECT_NEAR(alignment(vec2(3, 0), vec2(-7, 0)), 1.0f, 1e-6f);
    EXPECT_NEAR(alignment(vec2(3, 0), vec2(0, 2)), 0.0f, 1e-6f);
    EXPECT_NEAR(alignment(vec2(3, 3), vec2(0, 2)), std::sqrt(0.5f), 1e-6f);
    EXPECT_EQ(alignment(vec2(3, 3), vec2(0)), 0.0f);
    EXPECT_EQ(alignment(vec2(0), vec2(0)), 0.0f);
    EXPECT_LE(alignment(vec2(0.1f, 0.3f), vec2(0.1f, 0.3f)), 1.0f);
}

TEST(Guertin2014, TheSecondDirectionTurnsFromThePerpendicularToThePixelsOwn) {
    const vec2 dominant(1.0f, 0.0f);
    EXPECT_EQ(centreDirection(vec2(0.0f), dominant, 1.5f), vec2(0.0f, 1.0f));
    // Half a pixel of half velocity or less: the perpendicular, on the motion's side.
    EXPECT_EQ(centreDirection(vec2(0.5f, -0.5f), dominant, 1.5f), vec2(0.0f, -1.0f));
    // Half velocity 0.5 + gamma or more: its own.
    const vec2 own = centreDirection(vec2(-3.0f, -4.0f), dominant, 1.5f);
    EXPECT_NEAR(own.x, -0.6f, 1e-6f);
    EXPECT_NEAR(own.y, -0.8f, 1e-6f);
    float last = 0.0f;
    for (float speed = 0.0f; speed <= 5.0f; speed += 0.1f) {
        const vec2 direction = centreDirection(vec2(speed, 0.0f), dominant, 1.5f);
        EXPECT_NEAR(length(direction), 1.0f, 1e-6f);
        EXPECT_GE(direction.x, last - 1e-6f) << speed;
        last = direction.x;
    }
    EXPECT_NEAR(last, 1.0f, 1e-6f);
}

TEST(Guertin2014, TheVarianceIsTheShareOfTheSecondDirection) {
    for (const float variance : {0.0f, 0.1f, 0.5f, 8.0f / 9.0f, 1.0f})
        for (const uint count : {1u, 15u, 35u}) {
            uint second = 0;
            for (uint i = 0; i < count; ++i)
                second += isSecondDirection(i, variance) ? 1 : 0;
            EXPECT_EQ(second, uint(float(count) * variance)) << variance << " " << count;
        }
    // Every other one where it is a half.
    EXPECT_FALSE(isSecondDirection(0, 0.5f));
    EXPECT_TRUE(isSecondDirection(1, 0.5f));
    EXPECT_FALSE(isSecondDirection(2, 0.5f));
}

TEST(Guertin2014, TheJitterAndTheCentresWeightAreThePapers) {
    EXPECT_NEAR(guertinJitter(35), 0.95f * 27.0f / 35.0f, 1e-6f);
    EXPECT_EQ(guertinJitter(15), 1.0f);
    EXPECT_EQ(guertinJitter(1), 1.0f);
    EXPECT_NEAR(guertinCentreWeight(10.0f, 35, 40.0f), 35.0f / (40.0f * 5.0f), 1e-6f);
    EXPECT_NEAR(guertinCentreWeight(0.0f, 35, 40.0f), 35.0f / (40.0f * 0.5f), 1e-6f);
}

TEST(Guertin2014, EachPartOfTheWeightCountsByItsDirectionAndNoneIsNegativeOrInfinite) {
    // A sample in front, 4 px away: its cone, by how its motion lies along the tap.
    EXPECT_NEAR(guertinWeight(2.0f, 4.0f, 10.0f, 0.0f, 1.0f, 0.5f), 0.6f * 0.5f, 1e-6f);
    EXPECT_EQ(guertinWeight(2.0f, 4.0f, 10.0f, 0.0f, 1.0f, 0.0f), 0.0f);
    // One behind: the target's.
    EXPECT_NEAR(guertinWeight(-2.0f, 4.0f, 0.0f, 8.0f, 0.5f, 1.0f), 0.5f * 0.5f, 1e-6f);
    // Together: both cones and twice the shorter cylinder by the better direction.
    EXPECT_NEAR(
        guertinWeight(0.0f, 4.0f, 10.0f, 8.0f, 0.25f, 0.75f),
        0.6f * 0.75f + 0.5f * 0.25f + 1.5f,
        1e-6f
    );
    EXPECT_NEAR(guertinWeight(0.0f, 9.0f, 10.0f, 8.0f, 1.0f, 1.0f), 0.1f, 1e-6f)
        << "beyond the shorter";
    for (const float z : {-1e11f, -1.0f, 0.0f, 1.0f, 1e11f})
        for (const float distance : {0.0f, 0.5f, 1e6f})
            for (const float sample : {0.0f, 0.5f, 256.0f})
                for (const float target : {0.0f, 0.5f, 256.0f})
                    for (const float along : {0.0f, 1.0f}) {
                        const float weight =
                            guertinWeight(z, distance, sample, target, along, 1.0f - along);
                        EXPECT_TRUE(weight >= 0.0f && weight <= 4.0f);
                    }
}

TEST(Jimenez2014, DepthSharesASampleAndASpreadFadesOverOneTap) {
    EXPECT_EQ(classifyDepth(-1.0f), vec2(1.0f, 0.0f)); // the sample is deeper
    EXPECT_EQ(classifyDepth(1.0f), vec2(0.0f, 1.0f));
    EXPECT_EQ(classifyDepth(0.0f), vec2(0.5f, 0.5f));
    for (float z = -2.0f; z <= 2.0f; z += 0.05f) {
        const vec2 both = classifyDepth(z);
        EXPECT_NEAR(both.x + both.y, 1.0f, 1e-6f);
    }
    EXPECT_EQ(spreadCovers(3.0f, 2.9f), 1.0f);
    EXPECT_NEAR(spreadCovers(3.0f, 3.25f), 0.75f, 1e-6f);
    EXPECT_EQ(spreadCovers(3.0f, 4.0f), 0.0f);
}

TEST(Jimenez2014, AMoverInFrontCoversAndOneBehindShowsThroughTheTargetsSpreadByWeightsOfZeroToOne) {
    EXPECT_EQ(jimenezWeight(5.0f, 2.0f, 4.0f, 0.0f), 1.0f);  // in front, reaches
    EXPECT_EQ(jimenezWeight(5.0f, 6.0f, 4.0f, 9.0f), 0.0f);  // in front, does not
    EXPECT_EQ(jimenezWeight(-5.0f, 2.0f, 0.0f, 4.0f), 1.0f); // behind a smeared target
    EXPECT_EQ(jimenezWeight(-5.0f, 2.0f, 9.0f, 0.0f), 0.0f); // behind a still one
    for (const float z : {-1e11f, -0.3f, 0.0f, 0.3f, 1e11f})
        for (const float distance : {0.0f, 0.5f, 1e6f})
            for (const float sample : {0.0f, 0.5f, 256.0f})
                for (const float target : {0.0f, 0.5f, 256.0f}) {
                    const float weight = jimenezWeight(z, distance, sample, target);
                    EXPECT_TRUE(weight >= 0.0f && weight <= 1.0f);
                }
}

TEST(Jimenez2014, ThePairTakesTheWeightOfTheNearerAndFaster) {
    const vec2 weights(0.25f, 0.75f);
    // The first is deeper and slower: the second's for both, and the other way round.
    EXPECT_EQ(mirrorWeights(weights, vec2(9, 5), vec2(0, 8)), vec2(0.75f));
    EXPECT_EQ(mirrorWeights(weights, vec2(5, 9), vec2(8, 0)), vec2(0.25f));
    // Nearer but slower, or deeper but faster: each its own.
    EXPECT_EQ(mirrorWeights(weights, vec2(9, 5), vec2(8, 0)), weights);
    EXPECT_EQ(mirrorWeights(weights, vec2(5, 9), vec2(0, 8)), weights);
    // Equals: the first's.
    EXPECT_EQ(mirrorWeights(weights, vec2(5, 5), vec2(0, 0)), vec2(0.25f));
}

} // namespace
} // namespace shutter::shader
