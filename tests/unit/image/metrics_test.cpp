// SPDX-License-Identifier: MIT
// PSNR and SSIM: their laws, and other programs' values.
#include "engine/image/metrics.h"
#include "tests/unit/image/test_images.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace shutter::image {
namespace {

double luminanceOf(const Image& image, uint32_t x, uint32_t y) {
    if (image.channels < 3)
        return image.at(x, y, 0);
    return 0.2126 * image.at(x, y, 0) + 0.7152 * image.at(x, y, 1) + 0.0722 * image.at(x, y, 2);
}

/// The definition, one window: centred moments summed in two dimensions over the part inside.
double scoreWindowDirectly(const Image& a, const Image& b, int centreX, int centreY) {
    struct Sample {
        double weight, a, b;
    };

    std::vector<Sample> samples;
    double weightSum = 0.0;
    for (int y = std::max(centreY - 5, 0); y <= std::min(centreY + 5, int(a.height) - 1); ++y) {
        for (int x = std::max(centreX - 5, 0); x <= std::min(centreX + 5, int(a.width) - 1); ++x) {
            const double squared = std::pow(x - centreX, 2) + std::pow(y - centreY, 2);
            const auto ux = uint32_t(x);
            const auto uy = uint32_t(y);
            const double weight = std::exp(-squared / (2.0 * 1.5 * 1.5));
            samples.push_back({weight, luminanceOf(a, ux, uy), luminanceOf(b, ux, uy)});
            weightSum += weight;
        }
    }
    double meanA = 0.0, meanB = 0.0, varianceA = 0.0, varianceB = 0.0, covariance = 0.0;
    for (const Sample& s : samples) {
        meanA += s.weight / weightSum * s.a;
        meanB += s.weight / weightSum * s.b;
    }
    for (const Sample& s : samples) {
        varianceA += s.weight / weightSum * (s.a - meanA) * (s.a - meanA);
        varianceB += s.weight / weightSum * (s.b - meanB) * (s.b - meanB);
        covariance += s.weight / weightSum * (s.a - meanA) * (s.b - meanB);
    }
    return (2.0 * meanA * meanB + 1e-4) * (2.0 * covariance + 9e-4) /
           ((meanA * meanA + meanB * meanB + 1e-4) * (varianceA + varianceB + 9e-4));
}

double computeSsimDirectly(const Image& a, const Image& b) {
    const auto range = [](uint32_t size) {
        return size >= 11 ? std::array{5, int(size) - 5} : std::array{0, int(size)};
    };
    const auto [firstX, endX] = range(a.width);
    const auto [firstY, endY] = range(a.height);
    double sum = 0.0;
    for (int y = firstY; y < endY; ++y)
        for (int x = firstX; x < endX; ++x)
            sum += scoreWindowDirectly(a, b, x, y);
    return sum / ((endX - firstX) * (endY - firstY));
}

double ssimOfConstants(double a, double b) {
    return (2.0 * a * b + 1e-4) / (a * a + b * b + 1e-4);
}

TEST(Psnr, PsnrIsTheMeanSquareOverAllPixelsInDecibelsWithoutAlpha) {
    const Image noise = makeNoise(7, 5, 3, 1);
    EXPECT_EQ(computePsnr(noise, noise), double{kInfinity});
    EXPECT_EQ(computePsnr(Image(), Image()), double{kInfinity});
    EXPECT_NEAR(
        computePsnr(makeConstant(31, 17, 3, 0.25f), makeConstant(31, 17, 3, 0.35f)), 20.0, 1e-5
    );
    const Image black = makeConstant(10, 10, 1, 0.0f);
    Image spot = black;
    spot.at(3, 4, 0) = 1.0f;
    EXPECT_NEAR(computePsnr(black, spot), 20.0, 1e-12);
    const Image grey = makeConstant(4, 4, 4, 0.5f);
    Image other = grey;
    other.at(1, 1, 3) = 0.0f;
    EXPECT_EQ(computePsnr(grey, other), double{kInfinity});
    other.at(1, 1, 2) = 0.0f;
    EXPECT_NEAR(computePsnr(grey, other), 10.0 * std::log10(48.0 / 0.25), 1e-12);
}

TEST(Psnr, ValuesOutsideTheUnitRangeAreClampedAndNanIsTheLargestError) {
    const Image bright = makeConstant(3, 3, 3, kInfinity);
    const Image dark = makeConstant(3, 3, 3, -5.0f);
    EXPECT_EQ(computePsnr(bright, makeConstant(3, 3, 3, 1.0f)), double{kInfinity});
    EXPECT_EQ(computePsnr(dark, makeConstant(3, 3, 3, 0.0f)), double{kInfinity});
    EXPECT_NEAR(computePsnr(bright, dark), 0.0, 1e-12);
    const Image good = makeConstant(2, 2, 1, 0.5f);
    Image bad = good;
    bad.at(0, 1, 0) = kNan;
    for (const double found :
         {computePsnr(good, bad), computePsnr(bad, good), computePsnr(bad, bad)})
        EXPECT_NEAR(found, 10.0 * std::log10(4.0), 1e-12);
}

TEST(PsnrDeathTest, PicturesOfDifferentShapesAreRefused) {
    EXPECT_DEATH((void)computePsnr(Image(2, 3, 1), Image(3, 2, 1)), "width");
    EXPECT_DEATH((void)computePsnr(Image(2, 3, 1), Image(2, 2, 1)), "height");
    EXPECT_DEATH((void)computePsnr(Image(2, 3, 1), Image(2, 3, 3)), "channels");
}

TEST(Ssim, ConstantsLeaveTheLuminanceTermAlone) {
    for (const uint32_t size : {1u, 5u, 10u, 11u, 12u, 40u}) {
        const Image a = makeConstant(size, size, 3, 0.25f);
        const Image b = makeConstant(size, size, 3, 0.75f);
        EXPECT_NEAR(computeSsim(a, b), ssimOfConstants(0.25, 0.75), 1e-12) << size;
    }
}

TEST(Ssim, SsimFollowsTheDefinitionForSizesAroundTheWindow) {
    const Image image = makeNoise(40, 30, 3, 5);
    EXPECT_DOUBLE_EQ(computeSsim(image, image), 1.0);
    EXPECT_EQ(computeSsim(Image(), Image()), 1.0);
    for (const auto& [width, height] :
         {std::array{1u, 1u}, {5u, 5u}, {11u, 11u}, {13u, 5u}, {4u, 25u}, {33u, 27u}}) {
        for (const uint32_t channels : {1u, 3u, 4u}) {
            const Image a = makeNoise(width, height, channels, 6);
            const Image b = makeNoise(width, height, channels, 7);
            EXPECT_NEAR(computeSsim(a, b), computeSsimDirectly(a, b), 1e-10)
                << width << "x" << height << "x" << channels;
        }
    }
}

TEST(Ssim, ColourIsWeighedAsLuminanceAndInfinityClampedToOne) {
    const Image black = makeConstant(12, 12, 3, 0.0f);
    Image green = black;
    for (size_t i = 1; i < green.pixels.size(); i += 3)
        green.pixels[i] = 1.0f;
    EXPECT_NEAR(computeSsim(black, green), ssimOfConstants(0.0, 0.7152), 1e-12);
    const Image infinite = makeConstant(12, 12, 1, kInfinity);
    EXPECT_NEAR(
        computeSsim(infinite, makeConstant(12, 12, 1, 0.5f)), ssimOfConstants(1.0, 0.5), 1e-12
    );
}

TEST(Ssim, ANanSpoilsTheWindowsItLiesInAndNoOthers) {
    const Image good = makeConstant(33, 11, 1, 0.5f);
    Image bad = good;
    bad.at(0, 0, 0) = kNan;
    // 23 windows in one row; only the first reaches column 0.
    EXPECT_NEAR(computeSsim(good, bad), 22.0 / 23.0, 1e-12);
    EXPECT_NEAR(computeSsim(bad, good), 22.0 / 23.0, 1e-12);
}

TEST(StoredValues, StoredValuesScaleWithThePeakOfTheReferencesFiniteMagnitudes) {
    EXPECT_EQ(findPeak(makeConstant(2, 2, 3, 0.2f)), 1.0);
    Image image = makeConstant(2, 2, 3, -90.0f);
    image.pixels[0] = kInfinity;
    image.pixels[1] = kNan;
    image.pixels[2] = 40.0f;
    EXPECT_EQ(findPeak(image), 90.0);
    EXPECT_EQ(findPeak({}), 1.0);
    const auto scale = [](Image scaled, float factor) {
        for (float& value : scaled.pixels)
            value *= factor;
        return scaled;
    };
    Image a = makeNoise(20, 17, 2, 1);
    Image b = makeNoise(20, 17, 2, 2);
    b.pixels[0] = 1.0f; // the peak
    // A power of two changes no digit.
    EXPECT_EQ(computeStoredPsnr(scale(a, 1024.0f), scale(b, 1024.0f)), computeStoredPsnr(a, b));
    EXPECT_EQ(
        computeStoredSsim(scale(a, 1024.0f), scale(b, 1024.0f), false),
        computeStoredSsim(a, b, false)
    );
}

TEST(StoredValues, StoredValuesInTheUnitRangeHaveTheMetricsOfDisplayedOnes) {
    const Image a = makeNoise(20, 17, 3, 1);
    const Image b = makeNoise(20, 17, 3, 2);
    EXPECT_EQ(computeStoredPsnr(a, b), computePsnr(a, b));
    EXPECT_EQ(computeStoredSsim(a, b, true), computeSsim(a, b));
    const Image grey = makeNoise(20, 17, 1, 3);
    EXPECT_EQ(computeStoredSsim(grey, grey, false), 1.0);
}

TEST(StoredValues, StoredValuesAreNotClamped) {
    EXPECT_NEAR(
        computeStoredPsnr(makeConstant(4, 4, 2, 5.0f), makeConstant(4, 4, 2, 50.0f)),
        20.0 * std::log10(50.0 / 45.0),
        1e-9
    );
    EXPECT_LT(computeStoredPsnr(makeConstant(4, 4, 1, -9.0f), makeConstant(4, 4, 1, -90.0f)), 2.0);
    EXPECT_LT(computeStoredPsnr(makeConstant(4, 4, 1, 1e30f), makeConstant(4, 4, 1, 1.0f)), -500.0);
}

TEST(StoredValues, EveryChannelCounts) {
    const Image a = makeNoise(16, 16, 5, 1);
    for (uint32_t channel = 0; channel < 5; ++channel) {
        Image b = a;
        for (size_t i = channel; i < b.pixels.size(); i += 5)
            b.pixels[i] = 1.0f - b.pixels[i];
        EXPECT_LT(computeStoredPsnr(b, a), 20.0) << channel;
        EXPECT_LT(computeStoredSsim(b, a, false), 0.9) << channel;
    }
}

TEST(StoredValues, InfinityIsNoDifferenceToItselfAndNanIsOneOfThePeak) {
    Image a = makeNoise(30, 30, 1, 1);
    a.pixels[0] = kInfinity;
    EXPECT_EQ(computeStoredPsnr(a, a), double{kInfinity});
    EXPECT_EQ(computeStoredSsim(a, a, false), 1.0);
    for (const float wrong : {-kInfinity, kNan, 0.5f}) {
        Image b = a;
        b.pixels[0] = wrong;
        EXPECT_NEAR(computeStoredPsnr(b, a), 10.0 * std::log10(900.0), 1e-9) << wrong;
        EXPECT_LT(computeStoredSsim(b, a, false), 1.0) << wrong;
        EXPECT_GT(computeStoredSsim(b, a, false), 0.9) << wrong;
    }
}

TEST(MaxDifference, MaxDifferenceIsOverAllChannelsOfAllPixelsWithoutAClamp) {
    const Image a = makeConstant(9, 4, 3, 0.5f);
    Image b = a;
    EXPECT_EQ(computeMaxDifference(a, b), 0.0);
    b.at(2, 1, 0) = 0.75f;
    b.at(8, 3, 2) = -4.5f;
    EXPECT_EQ(computeMaxDifference(a, b), 5.0);
    EXPECT_EQ(computeMaxDifference(Image(), Image()), 0.0);
    const Image nan = makeConstant(1, 1, 1, kNan);
    const Image infinite = makeConstant(1, 1, 1, kInfinity);
    EXPECT_EQ(computeMaxDifference(infinite, infinite), 0.0);
    for (const float other : {0.0f, -kInfinity, kNan})
        EXPECT_EQ(computeMaxDifference(infinite, makeConstant(1, 1, 1, other)), double{kInfinity});
    EXPECT_EQ(computeMaxDifference(nan, makeConstant(1, 1, 1, 0.0f)), double{kInfinity});
    EXPECT_EQ(computeMaxDifference(nan, nan), double{kInfinity}) << "not even equal to itself";
}

/// Each third value scaled, the rest as it was.
Image disturb(const Image& image) {
    Image result = image;
    for (size_t i = 0; i < result.pixels.size(); i += 3)
        result.pixels[i] = std::round(result.pixels[i] * 200.0f) / 255.0f;
    return result;
}

/// By ffmpeg 5.1.9's filter psnr, formats gray and gbrp, of the pictures in files of eight bits.
TEST(Psnr, PsnrAgreesWithFfmpeg) {
    const Image grey = makeNoise(64, 48, 1, 2);
    EXPECT_NEAR(computePsnr(grey, disturb(grey)), 22.657677, 1e-6);
    EXPECT_NEAR(computePsnr(makeNoise(64, 48, 3, 3), makeNoise(64, 48, 3, 4)), 7.777942, 1e-6);
}

/// Wang 2004 by scikit-image 0.19.3 over Rec. 709 luminance of the pictures in files of eight bits,
/// mean over whole windows: structural_similarity(gaussian_weights=True, sigma=1.5,
/// use_sample_covariance=False, data_range=1.0, full=True)[1][5:-5, 5:-5].mean().
TEST(Ssim, SsimAgreesWithScikitImage) {
    const Image grey = makeNoise(64, 48, 1, 5);
    EXPECT_NEAR(computeSsim(grey, disturb(grey)), 0.971803785370, 1e-8);
    EXPECT_NEAR(computeSsim(grey, makeNoise(64, 48, 1, 6)), 0.004690495913, 1e-8);
    const Image color = makeNoise(64, 48, 3, 5);
    EXPECT_NEAR(computeSsim(color, disturb(color)), 0.996917030688, 1e-8);
    EXPECT_NEAR(computeSsim(color, makeNoise(64, 48, 3, 6)), 0.003811174416, 1e-8);
}

} // namespace
} // namespace shutter::image
