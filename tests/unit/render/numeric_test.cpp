// SPDX-License-Identifier: MIT
#include "shaders/common/numeric.glsl"

#include <gtest/gtest.h>

#include <ios>
#include <limits>

namespace shutter::shader {

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

} // namespace

TEST(Numeric, SaturateCutsBothEndsOff) {
    EXPECT_EQ(saturate(-1.0f), 0.0f);
    EXPECT_EQ(saturate(0.25f), 0.25f);
    EXPECT_EQ(saturate(7.0f), 1.0f);
    EXPECT_EQ(saturate(kInfinity), 1.0f);
    EXPECT_EQ(saturate(-kInfinity), 0.0f);
}

TEST(Numeric, LuminanceIsRec709sAndOneForWhite) {
    EXPECT_FLOAT_EQ(luminance(vec3(1.0f)), 1.0f);
    EXPECT_FLOAT_EQ(luminance(vec3(1.0f, 0.0f, 0.0f)), 0.2126f);
    EXPECT_FLOAT_EQ(luminance(vec3(0.0f, 2.0f, 0.0f)), 2.0f * 0.7152f);
    EXPECT_FLOAT_EQ(luminance(vec3(0.0f, 0.0f, 1.0f)), 0.0722f);
}

TEST(Numeric, NanAndInfinityAreNotFinite) {
    EXPECT_FALSE(isFinite(kNan));
    EXPECT_FALSE(isFinite(kInfinity));
    EXPECT_FALSE(isFinite(-kInfinity));
    EXPECT_TRUE(isFinite(0.0f));
    EXPECT_TRUE(isFinite(-3.4e38f));
    EXPECT_FALSE(isFinite(-kNan));
    EXPECT_TRUE(isFinite(std::numeric_limits<float>::denorm_min()));
    EXPECT_TRUE(isFinite(std::numeric_limits<float>::max()));
    EXPECT_TRUE(isFinite(std::numeric_limits<float>::lowest()));
}

TEST(Numeric, OnlyNanIsNotANumber) {
    // Quiet and signalling, of either sign, with the smallest and the largest payload.
    for (const uint bits : {0x7FC00000u, 0x7F800001u, 0x7FFFFFFFu, 0xFFC00000u, 0xFF800001u})
        EXPECT_TRUE(isNotANumber(uintBitsToFloat(bits))) << std::hex << bits;
    for (const float x : {0.0f, -0.0f, 1.0f, std::numeric_limits<float>::max(), kInfinity})
        EXPECT_FALSE(isNotANumber(x) || isNotANumber(-x)) << x;
}

TEST(Numeric, AStorableColourStaysAsItIs) {
    EXPECT_EQ(storableColor(vec3(0.0f, 0.5f, 64999.0f)), vec3(0.0f, 0.5f, 64999.0f));
}

TEST(Numeric, EachChannelThatNoHalfFloatCanHoldIsReplacedAlone) {
    EXPECT_EQ(storableColor(vec3(kNan, 1.0f, 2.0f)), vec3(0.0f, 1.0f, 2.0f));
    EXPECT_EQ(storableColor(vec3(1.0f, kNan, 2.0f)), vec3(1.0f, 0.0f, 2.0f));
    EXPECT_EQ(storableColor(vec3(1.0f, 2.0f, kNan)), vec3(1.0f, 2.0f, 0.0f));
    EXPECT_EQ(storableColor(vec3(kInfinity, -kInfinity, -1.0f)), vec3(kMaxColor, 0.0f, 0.0f));
    EXPECT_LT(kMaxColor, 65504.0f); // the largest half float
}

} // namespace shutter::shader
