// SPDX-License-Identifier: MIT
#include "engine/core/frame_rate.h"

#include <gtest/gtest.h>

#include <limits>

namespace shutter::core {

namespace {

FrameRate parse(const std::string& text) {
    const auto rate = parseFrameRate(text);
    EXPECT_TRUE(rate) << text;
    return rate ? rate.value() : FrameRate(1.0);
}

RationalRate rationalOf(const std::string& text) {
    const auto found = findRational(parse(text));
    EXPECT_TRUE(found) << text;
    return found.value_or(RationalRate{});
}

} // namespace

TEST(FrameRate, AFractionIsKeptAndANumberStaysWhatItIs) {
    EXPECT_EQ(parse("24000/1001"), FrameRate(24000.0, 1001.0));
    EXPECT_EQ(parse("24000/1001").perSecond(), 24000.0 / 1001.0);
    EXPECT_EQ(parse("29.97"), FrameRate(29.97));
    EXPECT_EQ(parse("25"), FrameRate(25.0));
    EXPECT_EQ(parse("24/1"), FrameRate(24.0));
    for (const char* text :
         {"24000/1001", "23.976", "29.97", "25", "1e-05", "2147483647/2147483647"})
        EXPECT_EQ(parse(describe(parse(text))), parse(text)) << text;
    EXPECT_EQ(describe(parse("30000/1001")), "30000/1001");
    EXPECT_EQ(describe(parse("29.97")), "29.97");
}

TEST(FrameRate, OfAFractionTheTimeOfAFrameIsRoundedOnce) {
    const FrameRate rate = parse("24000/1001");
    EXPECT_EQ(rate.secondsOf(24000.0), 1001.0);
    EXPECT_EQ(rate.secondsOf(240000000.0), 10010000.0);
    // Of a number it has the bits that a division gives.
    for (int frame = 0; frame < 1000; ++frame)
        ASSERT_EQ(FrameRate(29.97).secondsOf(frame), frame / 29.97) << frame;
}

TEST(FrameRate, WhatIsNoRateAboveZeroIsRefusedInASentence) {
    for (const char* text :
         {"",
          "0",
          "-24",
          "nan",
          "inf",
          "x",
          "0/1",
          "1/0",
          "-24000/1001",
          "24000/-1",
          "24000 / 1001",
          "24000/",
          "/1001",
          "24000/1001/1",
          "24.0/1.001",
          "24000/1001 ",
          "99999999999/1",
          "2147483648/1",
          "1/2147483648",
          "1e3/1"}) {
        const auto rate = parseFrameRate(text);
        ASSERT_FALSE(rate) << text;
        EXPECT_NE(rate.error().message.find("24000/1001"), std::string::npos) << text;
    }
}

TEST(FrameRate, IsStoredAsTheSimplestFractionThatIsTheSameNumber) {
    EXPECT_EQ(rationalOf("24000/1001"), (RationalRate{24000, 1001}));
    EXPECT_EQ(rationalOf("24"), (RationalRate{24, 1}));
    EXPECT_EQ(rationalOf("23.976"), (RationalRate{2997, 125}));
    EXPECT_EQ(rationalOf("29.97"), (RationalRate{2997, 100}));
    EXPECT_EQ(rationalOf("12.5"), (RationalRate{25, 2}));
    EXPECT_EQ(rationalOf("0.1"), (RationalRate{1, 10}));
    EXPECT_EQ(*findRational(24000.0 / 1001.0), (RationalRate{24000, 1001}));
    // A number that is no such fraction gets the nearest one.
    const RationalRate near = *findRational(3.141592653589793);
    EXPECT_NEAR(double(near.numerator) / near.denominator, 3.141592653589793, 1e-15);
    EXPECT_FALSE(findRational(1e-300));
    EXPECT_FALSE(findRational(1e12));
    EXPECT_EQ(*findRational(2147483647.0), (RationalRate{2147483647, 1}));
}

} // namespace shutter::core
