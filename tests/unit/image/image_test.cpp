// SPDX-License-Identifier: MIT
#include "engine/image/image.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace shutter::image {
namespace {

TEST(HalfFloat, WhatAHalfFloatHoldsStaysAndTheRestIsRoundedToTheNearest) {
    for (const float held : {0.0f, 1.0f, -0.75f, 47.0f / 64.0f, 0x1p-14f, 0x1p-24f, 65504.0f})
        EXPECT_EQ(roundToHalf(held), held);
    // Half floats of [1/2, 1) are 2^-11 apart.
    EXPECT_EQ(roundToHalf(0.5f + 0.4f * 0x1p-11f), 0.5f);
    EXPECT_EQ(roundToHalf(0.5f + 0.6f * 0x1p-11f), 0.5f + 0x1p-11f);
    EXPECT_EQ(roundToHalf(-0.5f - 0.6f * 0x1p-11f), -0.5f - 0x1p-11f);
}

TEST(HalfFloat, BeyondTheGreatestIsInfinityAndNaNStaysNaN) {
    EXPECT_EQ(roundToHalf(65519.0f), 65504.0f);
    EXPECT_EQ(roundToHalf(65520.0f), std::numeric_limits<float>::infinity());
    EXPECT_EQ(roundToHalf(-1e9f), -std::numeric_limits<float>::infinity());
    EXPECT_TRUE(std::isnan(roundToHalf(std::numeric_limits<float>::quiet_NaN())));
}

TEST(HalfFloat, APictureIsPackedInItsOrder) {
    Image picture(2, 1, 2);
    picture.pixels = {1.0f, -2.0f, 0.5f, 0.0f};
    // Sign, five bits of exponent with a bias of 15, ten bits of fraction.
    EXPECT_EQ(packHalf(picture), (std::vector<uint16_t>{0x3c00, 0xc000, 0x3800, 0x0000}));
}

std::array<float, 3> colorOf(float value) {
    Image map(1, 1, 1);
    map.pixels = {value};
    const Image color = colorWithMagma(map);
    return {color.at(0, 0, 0), color.at(0, 0, 1), color.at(0, 0, 2)};
}

void expectBytes(const std::array<float, 3>& color, const std::array<int, 3>& bytes, float within) {
    for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(color[c] * 255.0f, float(bytes[c]), within) << c;
}

} // namespace
} // namespace shutter::image
