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

TEST(Magma, GoesFromBlackToPaleYellowByThePublishedColours) {
    // matplotlib's magma at 0, 64, 128, 191 and 255 of 255.
    expectBytes(colorOf(0.0f), {0, 0, 4}, 0.01f);
    expectBytes(colorOf(64.0f / 255.0f), {81, 18, 124}, 3.0f);
    expectBytes(colorOf(128.0f / 255.0f), {183, 55, 121}, 3.0f);
    expectBytes(colorOf(191.0f / 255.0f), {251, 135, 97}, 3.0f);
    expectBytes(colorOf(1.0f), {252, 253, 191}, 0.01f);
}

TEST(Magma, GetsBrighterAllTheWay) {
    float last = -1.0f;
    for (int i = 0; i <= 1000; ++i) {
        const auto color = colorOf(float(i) / 1000.0f);
        const float luminance = 0.2126f * color[0] + 0.7152f * color[1] + 0.0722f * color[2];
        EXPECT_GT(luminance, last) << i;
        last = luminance;
    }
}

TEST(Magma, WhatIsOutsideTheRangeIsClampedAndNanIsTheWorst) {
    EXPECT_EQ(colorOf(-3.0f), colorOf(0.0f));
    EXPECT_EQ(colorOf(7.0f), colorOf(1.0f));
    EXPECT_EQ(colorOf(std::numeric_limits<float>::infinity()), colorOf(1.0f));
    EXPECT_EQ(colorOf(std::numeric_limits<float>::quiet_NaN()), colorOf(1.0f));
}

TEST(Magma, ColoursTheFirstChannelOfEachPixel) {
    Image map(2, 1, 2);
    map.pixels = {1.0f, 0.0f, 0.0f, 1.0f};
    const Image colors = colorWithMagma(map);
    EXPECT_GT(colors.at(0, 0, 0), 0.9f);
    EXPECT_EQ(colors.at(1, 0, 0), 0.0f);
    EXPECT_TRUE(colorWithMagma(Image()).pixels.empty());
}

} // namespace
} // namespace shutter::image
