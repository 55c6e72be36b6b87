// SPDX-License-Identifier: MIT
#include "shaders/truth/estimate.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace shutter::shader {
namespace {

/// But for what a quotient may err by.
void expectColor(const vec3& color, const vec3& expected) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(color[i], expected[i], 1e-6f * (1.0f + expected[i])) << i;
}

TEST(Estimate, RaysGoToTheSetsInTurn) {
    for (uint count = 0; count < 9; ++count) {
        uint sets[2] = {0, 0};
        for (uint i = 0; i < count; ++i)
            ++sets[setOfRay(i)];
        EXPECT_EQ(raysOfSet(count, 0), sets[0]);
        EXPECT_EQ(raysOfSet(count, 1), sets[1]);
    }
}

TEST(Estimate, TheMeanCountsEachRayOnce) {
    expectColor(meanOfSets(vec3(6.0f), vec3(2.0f), 4), vec3(2.0f));
    expectColor(meanOfSets(vec3(6.0f), vec3(3.0f), 3), vec3(3.0f));
    expectColor(meanOfSets(vec3(6.0f), vec3(0.0f), 1), vec3(6.0f));
}

TEST(Estimate, TheErrorIsHalfTheDifferenceOfTheMeans) {
    EXPECT_EQ(
        errorOfSets(vec3(8.0f, 0.0f, 2.0f), vec3(4.0f, 4.0f, 2.0f), 4), vec3(1.0f, 1.0f, 0.0f)
    );
    EXPECT_EQ(errorOfSets(vec3(4.0f), vec3(4.0f), 8), vec3(0.0f)) << "sets that agree";
    expectColor(errorOfSets(vec3(8.0f), vec3(4.0f), 3), vec3(0.0f));
    EXPECT_EQ(errorOfSets(vec3(5.0f), vec3(0.0f), 1), vec3(0.0f)) << "one ray";
}

TEST(Estimate, TheErrorsSquareIsTheVarianceOfTheMeanOfStratifiedSets) {
    // Each set is 8 jittered strata of x^2, the kind of set that the spread of its own samples
    // would overestimate the error by a factor of five.
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const auto drawSet = [&] {
        float sum = 0.0f;
        for (int k = 0; k < 8; ++k) {
            const float x = (float(k) + uniform(random)) / 8.0f;
            sum += x * x;
        }
        return vec3(sum);
    };
    double estimated = 0.0;
    double actual = 0.0;
    constexpr int kTrials = 20000;
    for (int i = 0; i < kTrials; ++i) {
        const vec3 a = drawSet();
        const vec3 b = drawSet();
        const double error = double(meanOfSets(a, b, 16).x) - 1.0 / 3.0;
        estimated += std::pow(double(errorOfSets(a, b, 16).x), 2.0) / kTrials;
        actual += error * error / kTrials;
    }
    EXPECT_NEAR(estimated / actual, 1.0, 0.05);
}

} // namespace
} // namespace shutter::shader
