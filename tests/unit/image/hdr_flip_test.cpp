// SPDX-License-Identifier: MIT
#include "engine/image/hdr_flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace shutter::image {
namespace {

/// Light from 1/8 to 8 in columns, and a square of `light` in the middle.
Image makeScene(float light, float factor = 1.0f) {
    Image picture(48, 32, 3);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const bool isInside = x >= 16 && x < 32 && y >= 8 && y < 24;
            const float columns = std::exp2(float(x / 8) - 3.0f);
            for (uint32_t c = 0; c < 3; ++c)
                picture.at(x, y, c) = factor * (isInside ? light : columns);
        }
    return picture;
}

TEST(HdrFlip, EqualPicturesHaveNoError) {
    const FlipResult flip = computeHdrFlip(makeScene(4.0f), makeScene(4.0f));
    EXPECT_EQ(flip.mean, 0.0);
    for (const float error : flip.errorMap.pixels)
        EXPECT_EQ(error, 0.0f);
}

TEST(HdrFlip, ExposuresLeadFromTheBrightestToTheMedian) {
    Image truth(3, 1, 3);
    for (uint32_t x = 0; x < 3; ++x)
        for (uint32_t c = 0; c < 3; ++c)
            truth.at(x, 0, c) = x == 0 ? 0.0f : x == 1 ? 1.0f : 16.0f;
    const ExposureRange range = findHdrFlipExposures(truth);
    // Light of 2.11887 is shown as 0.85: the larger root of 0.16002 x^2 - 0.2829 x - 0.119.
    EXPECT_NEAR(range.last, std::log2(2.11887), 1e-4);
    EXPECT_NEAR(range.first, range.last - 4.0, 1e-9);
    EXPECT_EQ(range.count, 4u);
}

TEST(HdrFlip, SeesWhatIsBrighterThanWhite) {
    const Image truth = makeScene(8.0f);
    const Image picture = makeScene(4.0f);
    const FlipResult flip = computeHdrFlip(picture, truth);
    EXPECT_GT(flip.errorMap.at(24, 16, 0), 0.1f);
    EXPECT_EQ(flip.errorMap.at(0, 0, 0), 0.0f);
    const auto whiten = [](Image image) {
        for (float& value : image.pixels)
            value = std::min(value, 1.0f);
        return image;
    };
    EXPECT_EQ(computeFlip(whiten(picture), whiten(truth)).mean, 0.0) << "FLIP does not";
}

TEST(HdrFlip, DoesNotDependOnTheUnitOfLight) {
    const double one = computeHdrFlip(makeScene(3.0f), makeScene(4.0f)).mean;
    const double other = computeHdrFlip(makeScene(3.0f, 1024.0f), makeScene(4.0f, 1024.0f)).mean;
    EXPECT_GT(one, 0.001);
    EXPECT_NEAR(other, one, 1e-4 * one);
}

TEST(HdrFlip, ANaNIsTheLargestErrorAndABlackPictureIsJudged) {
    const Image truth = makeScene(1.0f);
    Image broken = truth;
    broken.at(3, 3, 1) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(computeHdrFlip(broken, truth).errorMap.at(3, 3, 0), 1.0f);
    const Image black(16, 16, 3);
    EXPECT_EQ(computeHdrFlip(black, black).mean, 0.0);
    EXPECT_LE(findHdrFlipExposures(black).count, 20u);
    Image bright = truth;
    bright.at(3, 3, 1) = std::numeric_limits<float>::infinity();
    EXPECT_LE(computeHdrFlip(bright, truth).mean, 1.0);
}

} // namespace
} // namespace shutter::image
