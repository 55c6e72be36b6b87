// SPDX-License-Identifier: MIT
#include "shaders/motion_blur/taps.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace shutter::shader {

namespace {

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

} // namespace

TEST(Taps, TheyFillTheExposureEvenlyInEveryPhase) {
    for (const float share : kShares)
        for (const uint count : {1u, 2u, 15u, 256u})
            for (uint i = 0; i < count; ++i) {
                const float u = tapPosition(i, 0.5f, count, share);
                EXPECT_NEAR(u, (double(i) + 0.5) / count + double(share) - 1.0, 1e-6);
                EXPECT_GE(tapPosition(i, 0.0f, count, share), share - 1.0f - 1e-6f);
                EXPECT_LE(tapPosition(i, 0.999f, count, share), share + 1e-6f);
            }
}

TEST(Taps, InACentredExposureTheInnerOnesAreThePapers) {
    // t = mix(-1, 1, (i + j + 1) / (S + 1)) of a half velocity, which is half the motion.
    for (const uint count : {1u, 15u, 35u})
        for (uint i = 0; i < count; ++i)
            for (const double j : {-0.5, 0.0, 0.4}) {
                const double t = -1.0 + 2.0 * (i + j + 1.0) / (count + 1.0);
                EXPECT_NEAR(innerTapPosition(i, float(j), count, 0.5f), 0.5 * t, 1e-6);
            }
}

TEST(Taps, AResponseHasThemAtTheTimesOfItsLight) {
    const ResponseTable table = risingResponse();
    for (const float share : kShares)
        for (uint i = 0; i < 16; ++i) {
            const float even = tapPosition(i, 0.5f, 16, share);
            // What is seen at u was there at s = s_r - u.
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

TEST(Taps, WithoutJitterTheTileIsThePixelsOwn) {
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

} // namespace shutter::shader
