// SPDX-License-Identifier: MIT
#include "shaders/motion_blur/jimenez2014.glsl"

#include <gtest/gtest.h>

namespace shutter::shader {

TEST(Jimenez2014, ForegroundAndBackgroundShareASampleByDepth) {
    EXPECT_EQ(classifyDepth(-1.0f), vec2(1.0f, 0.0f)); // the sample is deeper
    EXPECT_EQ(classifyDepth(1.0f), vec2(0.0f, 1.0f));
    EXPECT_EQ(classifyDepth(0.0f), vec2(0.5f, 0.5f));
    for (float z = -2.0f; z <= 2.0f; z += 0.05f) {
        const vec2 both = classifyDepth(z);
        EXPECT_NEAR(both.x + both.y, 1.0f, 1e-6f);
    }
}

TEST(Jimenez2014, ASpreadCoversToItsEndAndFadesOverOneTap) {
    EXPECT_EQ(spreadCovers(3.0f, 2.9f), 1.0f);
    EXPECT_NEAR(spreadCovers(3.0f, 3.25f), 0.75f, 1e-6f);
    EXPECT_EQ(spreadCovers(3.0f, 4.0f), 0.0f);
}

TEST(Jimenez2014, AMoverInFrontCoversAndOneBehindShowsThroughTheTargetsSpread) {
    EXPECT_EQ(jimenezWeight(5.0f, 2.0f, 4.0f, 0.0f), 1.0f);  // in front, reaches
    EXPECT_EQ(jimenezWeight(5.0f, 6.0f, 4.0f, 9.0f), 0.0f);  // in front, does not
    EXPECT_EQ(jimenezWeight(-5.0f, 2.0f, 0.0f, 4.0f), 1.0f); // behind a smeared target
    EXPECT_EQ(jimenezWeight(-5.0f, 2.0f, 9.0f, 0.0f), 0.0f); // behind a still one
}

TEST(Jimenez2014, NoWeightLeavesZeroToOne) {
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

} // namespace shutter::shader
