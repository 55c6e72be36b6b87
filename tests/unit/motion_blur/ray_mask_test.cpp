// SPDX-License-Identifier: MIT
#include "shaders/motion_blur/ray_mask.glsl"

#include <gtest/gtest.h>

#include <array>

namespace shutter::shader {

namespace {

/// Horizontal response of the operator to values f(x, y) around a pixel.
template <class F> float respond(F&& f) {
    float sum = 0.0f;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x)
            sum += sobelDerive(x) * sobelSmooth(y) * f(x, y);
    return sum;
}

} // namespace

TEST(RayMask, TheOperatorIsTheSeparableFiveByFiveSobel) {
    // Rows of Pascal's triangle: the smoothing part is (1 1)^4, the derivative (1 1)^3 (-1 1).
    const std::array smooth{1.0f, 4.0f, 6.0f, 4.0f, 1.0f};
    const std::array derive{-1.0f, -2.0f, 0.0f, 2.0f, 1.0f};
    for (int offset = -2; offset <= 2; ++offset) {
        EXPECT_EQ(sobelSmooth(offset), smooth[size_t(offset + 2)]);
        EXPECT_EQ(sobelDerive(offset), derive[size_t(offset + 2)]);
    }
}

TEST(RayMask, AnEvenPlaneAnswersNothingAndASlopeAnswersByItsSteepness) {
    EXPECT_EQ(respond([](int, int) { return 7.0f; }), 0.0f);
    EXPECT_EQ(respond([](int, int y) { return float(y); }), 0.0f);
    const float slope = respond([](int x, int) { return float(x); });
    EXPECT_GT(slope, 0.0f);
    EXPECT_EQ(respond([](int x, int) { return -3.0f * float(x); }), -3.0f * slope);
}

TEST(RayMask, WithoutAnEdgeTheMeasureIsZero) {
    EXPECT_NEAR(edgeMeasure(vec2(0.0f), vec3(0.0f), vec3(0.0f)), 0.0f, 1e-6f);
}

TEST(RayMask, TheMeasureIsOneMinusOneOverXPlusOne) {
    // x = |depth| + |normal| = 5 + 3.
    const float measure =
        edgeMeasure(vec2(3.0f, -4.0f), vec3(1.0f, 2.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f));
    EXPECT_NEAR(measure, 1.0f - 1.0f / 9.0f, 1e-6f);
    EXPECT_NEAR(edgeMeasure(vec2(1.0f, 0.0f), vec3(0.0f), vec3(0.0f)), 0.5f, 1e-6f);
    EXPECT_NEAR(edgeMeasure(vec2(0.0f), vec3(0.0f), vec3(0.0f, 9.0f, 0.0f)), 0.9f, 1e-6f);
}

TEST(RayMask, ASharperEdgeMeasuresMoreAndNeverAboveOne) {
    float last = 0.0f;
    for (float x = 0.001f; x < 1e5f; x *= 2.0f) {
        const float measure = edgeMeasure(vec2(0.0f, x), vec3(0.0f), vec3(0.0f));
        EXPECT_GT(measure, last);
        EXPECT_LT(measure, 1.0f);
        last = measure;
    }
    // The sky's depth beside a near surface.
    EXPECT_LE(edgeMeasure(vec2(48.0e9f, 0.0f), vec3(0.0f), vec3(0.0f)), 1.0f);
}

} // namespace shutter::shader
