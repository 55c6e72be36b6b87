// SPDX-License-Identifier: MIT
#include "game/bench/crops.h"

#include <gtest/gtest.h>

#include <limits>

namespace shutter::bench {

namespace {

image::Image makeSpot(uint32_t x, uint32_t y, float value) {
    image::Image picture(64, 48, 3);
    picture.at(x, y, 1) = value;
    return picture;
}

} // namespace

TEST(Crops, TheSquareHoldsTheDifference) {
    const image::Image black(64, 48, 3);
    const auto found = findLargestDifference(makeSpot(40, 30, 1.0f), black, 16, "here", {});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_LE(found[0].x, 40u);
    EXPECT_GT(found[0].x + found[0].width, 40u);
    EXPECT_LE(found[0].y, 30u);
    EXPECT_GT(found[0].y + found[0].height, 30u);
    EXPECT_EQ(found[0].label, "here");
}

TEST(Crops, ATakenSquareIsNotMet) {
    image::Image two = makeSpot(8, 8, 1.0f);
    two.at(40, 30, 0) = 0.5f;
    const image::Image black(64, 48, 3);
    const auto first = findLargestDifference(two, black, 16, "", {});
    ASSERT_EQ(first.size(), 1u);
    EXPECT_LE(first[0].x, 8u);
    const auto second = findLargestDifference(two, black, 16, "", first);
    ASSERT_EQ(second.size(), 1u);
    EXPECT_GT(second[0].x, 16u);
}

TEST(Crops, EqualOrSmallPicturesHaveNone) {
    const image::Image black(64, 48, 3);
    EXPECT_TRUE(findLargestDifference(black, black, 16, "", {}).empty());
    EXPECT_TRUE(findLargestDifference(makeSpot(1, 1, 1.0f), black, 65, "", {}).empty());
}

TEST(Crops, NaNCountsAsADifference) {
    const image::Image black(64, 48, 3);
    const auto spot = makeSpot(40, 30, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(findLargestDifference(spot, black, 16, "", {}).size(), 1u);
}

} // namespace shutter::bench
