// SPDX-License-Identifier: MIT
#include "engine/image/magma.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

using namespace shutter::image;

namespace {

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
