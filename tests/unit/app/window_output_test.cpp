// SPDX-License-Identifier: MIT
#include "engine/app/window_output.h"

#include <gtest/gtest.h>

namespace shutter::app {
namespace {

TEST(FitPicture, KeepsThePicturesShapeInTheMiddle) {
    const PixelRect wide = fitPicture({1280, 720}, {1280, 1000});
    EXPECT_EQ(wide.origin, math::dvec2(0.0, 140.0));
    EXPECT_EQ(wide.extent, math::dvec2(1280.0, 720.0));
    const PixelRect tall = fitPicture({100, 200}, {300, 100});
    EXPECT_EQ(tall.origin, math::dvec2(125.0, 0.0));
    EXPECT_EQ(tall.extent, math::dvec2(50.0, 100.0));
}

TEST(FitPicture, FillsTheWindowWhereRoundingAloneParts) {
    // Half of 961 x 541, rounded.
    const PixelRect rect = fitPicture({481, 271}, {961, 541});
    EXPECT_EQ(rect.origin, math::dvec2(0.0));
    EXPECT_EQ(rect.extent, math::dvec2(961.0, 541.0));
    const PixelRect one = fitPicture({1, 1}, {1, 1});
    EXPECT_EQ(one.extent, math::dvec2(1.0));
}

} // namespace
} // namespace shutter::app
