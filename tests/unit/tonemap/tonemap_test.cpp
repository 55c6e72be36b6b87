// SPDX-License-Identifier: MIT
#include "shaders/tonemap/tonemap.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace shutter::shader {
namespace {

/// Khronos PBR Neutral as its specification words it, in double precision.
std::array<double, 3> neutralBySpecification(std::array<double, 3> c) {
    constexpr double kF90 = 0.04;
    constexpr double kStart = 0.8 - kF90;
    constexpr double kDesaturation = 0.15;
    const double x = *std::min_element(c.begin(), c.end());
    const double offset = x < 2.0 * kF90 ? x - x * x / (4.0 * kF90) : kF90;
    for (double& channel : c)
        channel -= offset;
    const double peak = *std::max_element(c.begin(), c.end());
    if (peak <= kStart)
        return c;
    const double newPeak = 1.0 - (1.0 - kStart) * (1.0 - kStart) / (peak + 1.0 - 2.0 * kStart);
    const double g = 1.0 / (kDesaturation * (peak - newPeak) + 1.0);
    for (double& channel : c)
        channel = channel * newPeak / peak * g + newPeak * (1.0 - g);
    return c;
}

void expectNeutral(const vec3& color) {
    const vec3 mapped = toneMapNeutral(color);
    const auto expected = neutralBySpecification({color.x, color.y, color.z});
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(mapped[i], expected[size_t(i)], 2e-5) << color.x << " " << color.y;
        EXPECT_TRUE(mapped[i] >= -1e-6f && mapped[i] <= 1.0f) << mapped[i];
    }
}

/// IEC 61966-2-1.
double srgbByStandard(double x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

TEST(Tonemap, NeutralIsTheSpecifications) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> stops(-10.0f, 15.0f);
    for (int i = 0; i < 2000; ++i)
        expectNeutral(
            vec3(std::exp2(stops(random)), std::exp2(stops(random)), std::exp2(stops(random)))
        );
}

TEST(Tonemap, BlackStaysBlackAndTheBrightestStorableIsNearlyWhite) {
    EXPECT_EQ(toneMapNeutral(vec3(0.0f)), vec3(0.0f));
    const vec3 brightest = toneMapNeutral(vec3(kMaxColor));
    EXPECT_GT(brightest.x, 0.999f);
    EXPECT_LE(brightest.x, 1.0f);
    expectNeutral(vec3(kMaxColor, 0.0f, 0.0f));
}

TEST(Tonemap, NeutralRisesWithTheInputAndDoesNotJump) {
    float last = 0.0f;
    for (float x = 0.001f; x < 100.0f; x *= 1.01f) {
        const float mapped = toneMapNeutral(vec3(x)).x;
        EXPECT_GT(mapped, last);
        EXPECT_LT(mapped - last, 0.011f * std::max(x, 0.01f) + 1e-6f);
        last = mapped;
    }
}

TEST(Tonemap, EncodingIsTheStandardsAndCutsOffWhatNoDisplayShows) {
    for (int i = 0; i <= 1000; ++i) {
        const float x = float(i) / 1000.0f;
        EXPECT_NEAR(encodeSrgb(x), srgbByStandard(x), 1e-6);
    }
    EXPECT_EQ(encodeSrgb(0.0f), 0.0f);
    EXPECT_EQ(encodeSrgb(-1.0f), 0.0f);
    EXPECT_EQ(encodeSrgb(7.0f), encodeSrgb(1.0f));
    EXPECT_EQ(
        encodeSrgb3(vec3(0.1f, 0.2f, 2.0f)),
        vec3(encodeSrgb(0.1f), encodeSrgb(0.2f), encodeSrgb(1.0f))
    );
}

} // namespace
} // namespace shutter::shader
