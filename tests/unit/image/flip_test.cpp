// SPDX-License-Identifier: MIT
// FLIP of pictures for displays and of high dynamic range.
#include "engine/image/flip.h"
#include "tests/unit/image/test_images.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::image {
namespace {

// Pictures by formula, in integers alone, so that every machine makes the same: what FLIP's
// authors' tool was given.

/// Eight bits per channel, interleaved RGB.
struct BytePicture {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> bytes;

    template <typename Paint> // Paint(x, y, channel) -> 0 ... 255
    BytePicture(uint32_t w, uint32_t h, Paint paint) : width(w), height(h) {
        for (uint32_t y = 0; y < h; ++y)
            for (uint32_t x = 0; x < w; ++x)
                for (uint32_t c = 0; c < 3; ++c)
                    bytes.push_back(static_cast<uint8_t>(paint(x, y, c)));
    }
};

struct PicturePair {
    BytePicture reference;
    BytePicture test;
};

/// No pattern over x, y and channel.
uint32_t hashByte(uint32_t x, uint32_t y, uint32_t c, uint32_t seed) {
    uint32_t h = x * 73856093u ^ y * 19349663u ^ c * 83492791u ^ seed * 2654435761u;
    h = (h ^ (h >> 16)) * 0x7FEB352Du;
    h = (h ^ (h >> 15)) * 0x846CA68Bu;
    return (h ^ (h >> 16)) & 0xFFu;
}

/// The pair that a row of the table below names; empty pictures for an unknown name.
PicturePair makePicturePair(std::string_view name) {
    const auto pair = [](uint32_t w, uint32_t h, auto reference, auto test) {
        return PicturePair{BytePicture(w, h, reference), BytePicture(w, h, test)};
    };
    const auto constant = [](uint32_t r, uint32_t g, uint32_t b) {
        return [=](uint32_t, uint32_t, uint32_t c) { return c == 0 ? r : (c == 1 ? g : b); };
    };
    const auto noise = [](uint32_t seed) {
        return [=](uint32_t x, uint32_t y, uint32_t c) { return hashByte(x, y, c, seed); };
    };
    const auto ramp = [](uint32_t x, uint32_t y, uint32_t c) {
        return c == 0 ? x * 2 : (c == 1 ? y * 3 : 255 - x - y);
    };
    const auto edge = [](uint32_t at) {
        return [=](uint32_t x, uint32_t, uint32_t c) { return x < at ? 40u + 30 * c : 220u; };
    };
    const auto lines = [](uint32_t at) {
        return [=](uint32_t x, uint32_t y, uint32_t) {
            return (x + at) % 16 == 0 || (y + 2 * at) % 24 == 0 ? 255u : 20u;
        };
    };
    if (name == "black, white")
        return pair(64, 48, constant(0, 0, 0), constant(255, 255, 255));
    if (name == "green, blue")
        return pair(40, 40, constant(0, 255, 0), constant(0, 0, 255));
    if (name == "grey, a little brighter")
        return pair(40, 40, constant(128, 128, 128), constant(131, 131, 131));
    if (name == "ramp, noisy ramp")
        return pair(96, 64, ramp, [&](uint32_t x, uint32_t y, uint32_t c) {
            return (ramp(x, y, c) * 7 + hashByte(x, y, c, 1)) / 8;
        });
    if (name == "noise, other noise")
        return pair(80, 60, noise(2), noise(3));
    if (name == "edge, edge moved")
        return pair(64, 64, edge(30), edge(33));
    if (name == "thin lines, moved")
        return pair(97, 61, lines(0), lines(5));
    if (name == "one firefly")
        return pair(33, 33, constant(30, 40, 50), [](uint32_t x, uint32_t y, uint32_t c) {
            return x == 16 && y == 16 ? 255u : 30 + 10 * c;
        });
    if (name == "noise, 17x13")
        return pair(17, 13, noise(4), noise(5));
    if (name == "1x1")
        return pair(1, 1, constant(10, 100, 200), constant(200, 100, 10));
    if (name == "equal noise")
        return pair(50, 30, noise(6), noise(6));
    if (name == "stripes, red and cyan")
        return pair(
            60,
            40,
            [](uint32_t x, uint32_t, uint32_t c) { return (x / 2) % 2 == (c == 0) ? 255u : 0u; },
            [](uint32_t x, uint32_t, uint32_t c) { return (x / 2) % 2 != (c == 0) ? 255u : 0u; }
        );
    return pair(0, 0, constant(0, 0, 0), constant(0, 0, 0));
}

/// Results of FLIP's authors' own tool: github.com/NVlabs/flip, commit 1eb247c (after version 1.6),
/// FLIP::evaluate of src/cpp/FLIP.h on the CPU, built with g++ 12.2 -O2, LDR, default parameters,
/// given makePicturePair(name) decoded by its own sRGBToLinearRGB.
struct Published {
    const char* name;
    double mean;
    double largest;
};

constexpr Published kByAuthorsTool[] = {
    {"black, white", 0.9673883, 0.9673883},
    {"green, blue", 1.0000000, 1.0000000},
    {"grey, a little brighter", 0.0643691, 0.0643691},
    {"ramp, noisy ramp", 0.1581098, 0.3408792},
    {"noise, other noise", 0.4527765, 0.9829267},
    {"edge, edge moved", 0.0956269, 0.9341021},
    {"thin lines, moved", 0.6524265, 0.9934419},
    {"one firefly", 0.0097740, 0.7157240},
    {"noise, 17x13", 0.4370696, 0.8663967},
    {"1x1", 0.9556308, 0.9556308},
    {"equal noise", 0.0000000, 0.0000000},
    {"stripes, red and cyan", 0.6375987, 0.9704982},
};

Image toImage(const BytePicture& picture) {
    Image image(picture.width, picture.height, 3);
    std::transform(
        picture.bytes.begin(),
        picture.bytes.end(),
        image.pixels.begin(),
        [](uint8_t byte) { return float(byte) / 255.0f; }
    );
    return image;
}

Image makeHashedNoise(uint32_t width, uint32_t height, uint32_t channels, uint32_t seed) {
    Image image(width, height, channels);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (uint32_t c = 0; c < channels; ++c)
                image.at(x, y, c) = float(hashByte(x, y, c, seed)) / 255.0f;
    return image;
}

/// White to the left of the middle, black to the right, with a linear slope `widthPx` wide between.
Image makeBlurredEdge(float widthPx) {
    Image image(96, 32, 3);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x)
            for (uint32_t c = 0; c < 3; ++c)
                image.at(x, y, c) =
                    std::clamp(0.5f - (float(x) + 0.5f - 48.0f) / widthPx, 0.0f, 1.0f);
    return image;
}

float largestOf(const Image& map) {
    return *std::max_element(map.pixels.begin(), map.pixels.end());
}

TEST(Flip, FlipAgreesWithItsAuthorsTool) {
    for (const Published& expected : kByAuthorsTool) {
        const PicturePair pair = makePicturePair(expected.name);
        ASSERT_FALSE(pair.reference.bytes.empty()) << expected.name;
        const FlipResult flip = computeFlip(toImage(pair.reference), toImage(pair.test));
        EXPECT_NEAR(flip.mean, expected.mean, 1e-5) << expected.name;
        EXPECT_NEAR(double(largestOf(flip.errorMap)), expected.largest, 1e-5) << expected.name;
    }
}

TEST(Flip, FlipIsSymmetricAndItsMapHasOneErrorAPixelInTheUnitRangeOfWhichTheMeanIs) {
    const Image a = makeHashedNoise(37, 29, 3, 1);
    const Image b = makeHashedNoise(37, 29, 3, 2);
    const FlipResult flip = computeFlip(a, b);
    EXPECT_EQ(flip.mean, computeFlip(b, a).mean);
    EXPECT_EQ(flip.errorMap.pixels, computeFlip(b, a).errorMap.pixels);
    ASSERT_EQ(flip.errorMap.width, 37u);
    ASSERT_EQ(flip.errorMap.height, 29u);
    ASSERT_EQ(flip.errorMap.channels, 1u);
    double sum = 0.0;
    for (const float error : flip.errorMap.pixels) {
        EXPECT_TRUE(error >= 0.0f && error <= 1.0f) << error;
        sum += double(error);
    }
    EXPECT_NEAR(flip.mean, sum / (37.0 * 29.0), 1e-12);
}

TEST(Flip, TheFurtherAnEdgeIsBlurredTheLargerTheError) {
    const Image sharp = makeBlurredEdge(1.0f);
    double last = 0.0;
    for (const float widthPx : {2.0f, 4.0f, 8.0f, 16.0f, 32.0f}) {
        const double mean = computeFlip(sharp, makeBlurredEdge(widthPx)).mean;
        EXPECT_GT(mean, last) << widthPx;
        last = mean;
    }
}

TEST(Flip, MirroringBothMirrorsTheMap) {
    const auto mirror = [](const Image& image) {
        Image result = image;
        for (uint32_t y = 0; y < image.height; ++y)
            for (uint32_t x = 0; x < image.width; ++x)
                for (uint32_t c = 0; c < image.channels; ++c)
                    result.at(image.width - 1 - x, image.height - 1 - y, c) = image.at(x, y, c);
        return result;
    };
    const Image a = makeHashedNoise(31, 23, 3, 7);
    const Image b = makeHashedNoise(31, 23, 3, 8);
    const Image mirrored = mirror(computeFlip(mirror(a), mirror(b)).errorMap);
    const Image straight = computeFlip(a, b).errorMap;
    // Differences of features are roots of differences, so rounding shows in the fourth digit.
    for (size_t i = 0; i < straight.pixels.size(); ++i)
        EXPECT_NEAR(mirrored.pixels[i], straight.pixels[i], 2e-3f) << i;
}

TEST(Flip, OneChannelIsGreyAndAlphaIsNotCompared) {
    const Image greyA = makeHashedNoise(24, 20, 1, 3);
    const Image greyB = makeHashedNoise(24, 20, 1, 4);
    const auto widen = [](const Image& grey, float alpha) {
        Image image(grey.width, grey.height, 4);
        for (size_t i = 0; i < grey.pixels.size(); ++i) {
            std::fill_n(image.pixels.begin() + ptrdiff_t(4 * i), 3, grey.pixels[i]);
            image.pixels[4 * i + 3] = alpha;
        }
        return image;
    };
    EXPECT_EQ(
        computeFlip(greyA, greyB).errorMap.pixels,
        computeFlip(widen(greyA, 0.0f), widen(greyB, 1.0f)).errorMap.pixels
    );
}

TEST(Flip, ValuesOutsideTheUnitRangeAreClampedAndPicturesWithoutPixelsAreEqual) {
    const auto compare = [](float a, float b) {
        return computeFlip(makeConstant(9, 9, 3, a), makeConstant(9, 9, 3, b)).mean;
    };
    EXPECT_EQ(compare(kInfinity, 1.0f), 0.0);
    EXPECT_EQ(compare(-kInfinity, 0.0f), 0.0);
    EXPECT_EQ(computeFlip(Image(), Image()).mean, 0.0);
    EXPECT_EQ(computeFlip(Image(0, 5, 3), Image(0, 5, 3)).mean, 0.0);
}

TEST(Flip, ANanIsTheLargestErrorWhereverAFilterReachesItAndNowhereElse) {
    const Image good = makeConstant(64, 64, 3, 0.5f);
    Image bad = good;
    bad.at(32, 32, 1) = kNan;
    for (const FlipResult& flip :
         {computeFlip(good, bad), computeFlip(bad, good), computeFlip(bad, bad)}) {
        for (uint32_t y = 0; y < 64; ++y)
            for (uint32_t x = 0; x < 64; ++x) {
                const bool reached = x >= 22 && x <= 42 && y >= 22 && y <= 42;
                ASSERT_EQ(flip.errorMap.at(x, y, 0), reached ? 1.0f : 0.0f) << x << " " << y;
            }
        EXPECT_NEAR(flip.mean, 21.0 * 21.0 / (64.0 * 64.0), 1e-12);
    }
}

TEST(FlipDeathTest, PicturesOfDifferentShapesAreRefused) {
    EXPECT_DEATH((void)computeFlip(Image(2, 3, 1), Image(3, 2, 1)), "width");
    EXPECT_DEATH((void)computeFlip(Image(2, 3, 1), Image(2, 2, 1)), "height");
    EXPECT_DEATH((void)computeFlip(Image(2, 3, 1), Image(2, 3, 3)), "channels");
}

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

TEST(HdrFlip, HdrFlipDetectsDifferencesAboveWhite) {
    const Image truth = makeScene(8.0f);
    const Image picture = makeScene(4.0f);
    const FlipResult flip = computeHdrFlip(picture, truth);
    EXPECT_GT(flip.errorMap.at(24, 16, 0), 0.1f);
    EXPECT_EQ(flip.errorMap.at(0, 0, 0), 0.0f);
    EXPECT_EQ(computeHdrFlip(truth, truth).mean, 0.0);
    EXPECT_EQ(largestOf(computeHdrFlip(truth, truth).errorMap), 0.0f);
    const auto whiten = [](Image image) {
        for (float& value : image.pixels)
            value = std::min(value, 1.0f);
        return image;
    };
    EXPECT_EQ(computeFlip(whiten(picture), whiten(truth)).mean, 0.0) << "FLIP does not";
}

TEST(HdrFlip, HdrFlipIsIndependentOfTheUnitOfLight) {
    const double one = computeHdrFlip(makeScene(3.0f), makeScene(4.0f)).mean;
    const double other = computeHdrFlip(makeScene(3.0f, 1024.0f), makeScene(4.0f, 1024.0f)).mean;
    EXPECT_GT(one, 0.001);
    EXPECT_NEAR(other, one, 1e-4 * one);
}

TEST(HdrFlip, ANaNIsTheLargestErrorAndABlackPictureIsJudged) {
    const Image truth = makeScene(1.0f);
    Image broken = truth;
    broken.at(3, 3, 1) = kNan;
    EXPECT_EQ(computeHdrFlip(broken, truth).errorMap.at(3, 3, 0), 1.0f);
    const Image black(16, 16, 3);
    EXPECT_EQ(computeHdrFlip(black, black).mean, 0.0);
    EXPECT_LE(findHdrFlipExposures(black).count, 20u);
    Image bright = truth;
    bright.at(3, 3, 1) = kInfinity;
    EXPECT_LE(computeHdrFlip(bright, truth).mean, 1.0);
}

} // namespace
} // namespace shutter::image
