// SPDX-License-Identifier: MIT
#include "shaders/motion_blur/guertin2014.glsl"

#include <gtest/gtest.h>

#include <cmath>

namespace shutter::shader {

TEST(Guertin2014, OnlyTilesWhoseLinePassesReachThisOne) {
    // Beside: any motion with a part along the axis, either way. On the diagonal: along it only.
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

TEST(Guertin2014, TheJitterIsThePapersAndNeverLongerThanATap) {
    EXPECT_NEAR(guertinJitter(35), 0.95f * 27.0f / 35.0f, 1e-6f);
    EXPECT_EQ(guertinJitter(15), 1.0f);
    EXPECT_EQ(guertinJitter(1), 1.0f);
}

TEST(Guertin2014, EachPartOfTheWeightCountsByItsDirection) {
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
}

TEST(Guertin2014, TheCentreWeighsAsThePaperSays) {
    EXPECT_NEAR(guertinCentreWeight(10.0f, 35, 40.0f), 35.0f / (40.0f * 5.0f), 1e-6f);
    EXPECT_NEAR(guertinCentreWeight(0.0f, 35, 40.0f), 35.0f / (40.0f * 0.5f), 1e-6f);
}

TEST(Guertin2014, NoWeightIsNegativeOrInfinite) {
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

} // namespace shutter::shader
