// SPDX-License-Identifier: MIT
#include "shaders/motion_blur/denoise.glsl"

#include <gtest/gtest.h>

#include <cmath>

namespace shutter::shader {

TEST(Denoise, TheDeviationOfAMeanIsThatOfItsValues) {
    // 1, 2, 3, 4, 5: variance 2.5.
    EXPECT_NEAR(deviationOfMean(15.0f, 55.0f, 5), std::sqrt(2.5f) / 5.0f, 1e-6f);
    EXPECT_EQ(deviationOfMean(20.0f, 100.0f, 4), 0.0f); // all 5
}

TEST(Denoise, TooFewRaysTellNoDeviation) {
    EXPECT_EQ(deviationOfMean(0.0f, 0.0f, 0), 0.0f);
    EXPECT_EQ(deviationOfMean(1.0f, 1.0f, 1), 0.0f);
    EXPECT_EQ(deviationOfMean(6.0f, 20.0f, 3), 0.0f);
}

TEST(Denoise, RoundingBelowZeroVarianceIsNotNaN) {
    // The squares' sum is a little too small, as rounding leaves it.
    EXPECT_EQ(deviationOfMean(4000.0f, 3999999.5f, 4), 0.0f);
}

TEST(Denoise, TheKernelsWeightsSumToOne) {
    float sum = 0.0f;
    for (int k = -2; k <= 2; ++k) {
        EXPECT_EQ(atrousWeight(k), atrousWeight(-k));
        sum += atrousWeight(k);
    }
    EXPECT_EQ(sum, 1.0f);
}

TEST(Denoise, EqualLightAlwaysCountsAndNoiseFreePixelsTakeNothingElse) {
    EXPECT_FLOAT_EQ(luminanceWeight(0.0f, 0.0f, 4.0f), 1.0f);
    EXPECT_FLOAT_EQ(luminanceWeight(0.0f, 0.3f, 4.0f), 1.0f);
    EXPECT_LT(luminanceWeight(0.01f, 0.0f, 4.0f), 1e-30f);
    EXPECT_GT(luminanceWeight(-0.01f, 0.1f, 4.0f), 0.97f);
    EXPECT_EQ(luminanceWeight(-0.5f, 0.1f, 4.0f), luminanceWeight(0.5f, 0.1f, 4.0f));
    EXPECT_EQ(luminanceWeight(65000.0f, 0.0f, 0.01f), 0.0f);
}

TEST(Denoise, ALevelStaysWithinHalfTheSmear) {
    EXPECT_TRUE(levelFits(1.0f, 4.0f));
    EXPECT_FALSE(levelFits(1.0f, 3.9f));
    EXPECT_TRUE(levelFits(16.0f, 64.0f));
    EXPECT_FALSE(levelFits(16.0f, 40.0f));
    EXPECT_FALSE(levelFits(1.0f, 0.0f));
}

} // namespace shutter::shader
