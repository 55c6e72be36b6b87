// SPDX-License-Identifier: MIT
// Pictures in memory, channels by name, and the parts of metrics.
#include "engine/image/channels.h"
#include "engine/image/image.h"
#include "engine/image/metric_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace shutter::image {
namespace {

TEST(HalfFloat, ValuesAreRoundedToTheNearestHalfFloatAndPackedInTheirOrder) {
    for (const float held : {0.0f, 1.0f, -0.75f, 47.0f / 64.0f, 0x1p-14f, 0x1p-24f, 65504.0f})
        EXPECT_EQ(roundToHalf(held), held);
    // Half floats of [1/2, 1) are 2^-11 apart.
    EXPECT_EQ(roundToHalf(0.5f + 0.4f * 0x1p-11f), 0.5f);
    EXPECT_EQ(roundToHalf(0.5f + 0.6f * 0x1p-11f), 0.5f + 0x1p-11f);
    EXPECT_EQ(roundToHalf(-0.5f - 0.6f * 0x1p-11f), -0.5f - 0x1p-11f);
    EXPECT_EQ(roundToHalf(65519.0f), 65504.0f);
    EXPECT_EQ(roundToHalf(65520.0f), std::numeric_limits<float>::infinity());
    EXPECT_EQ(roundToHalf(-1e9f), -std::numeric_limits<float>::infinity());
    EXPECT_TRUE(std::isnan(roundToHalf(std::numeric_limits<float>::quiet_NaN())));
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

TEST(Magma, ColoursGoFromBlackToPaleYellowAsPublishedAndGetBrighterAllTheWay) {
    // matplotlib's magma at 0, 64, 128, 191 and 255 of 255.
    expectBytes(colorOf(0.0f), {0, 0, 4}, 0.01f);
    expectBytes(colorOf(64.0f / 255.0f), {81, 18, 124}, 3.0f);
    expectBytes(colorOf(128.0f / 255.0f), {183, 55, 121}, 3.0f);
    expectBytes(colorOf(191.0f / 255.0f), {251, 135, 97}, 3.0f);
    expectBytes(colorOf(1.0f), {252, 253, 191}, 0.01f);
    float last = -1.0f;
    for (int i = 0; i <= 1000; ++i) {
        const auto color = colorOf(float(i) / 1000.0f);
        const float luminance = 0.2126f * color[0] + 0.7152f * color[1] + 0.0722f * color[2];
        EXPECT_GT(luminance, last) << i;
        last = luminance;
    }
}

TEST(Magma, TheFirstChannelOfEachPixelIsColouredClampedToItsRangeAndNanAsTheWorst) {
    EXPECT_EQ(colorOf(-3.0f), colorOf(0.0f));
    EXPECT_EQ(colorOf(7.0f), colorOf(1.0f));
    EXPECT_EQ(colorOf(std::numeric_limits<float>::infinity()), colorOf(1.0f));
    EXPECT_EQ(colorOf(std::numeric_limits<float>::quiet_NaN()), colorOf(1.0f));
    Image map(2, 1, 2);
    map.pixels = {1.0f, 0.0f, 0.0f, 1.0f};
    const Image colors = colorWithMagma(map);
    EXPECT_GT(colors.at(0, 0, 0), 0.9f);
    EXPECT_EQ(colors.at(1, 0, 0), 0.0f);
    EXPECT_TRUE(colorWithMagma(Image()).pixels.empty());
}

Image makeNamed(const std::vector<std::string>& names) {
    Image picture(2, 1, uint32_t(names.size()));
    for (size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = float(i);
    picture.channelNames = names;
    return picture;
}

/// "2,1,0/3": red, green and blue, and alpha; "-" where there is no colour.
std::string colorOf(const Image& picture) {
    const auto color = findColor(picture);
    if (!color)
        return "-";
    std::string text;
    for (const uint32_t c : color->color)
        text += (text.empty() ? "" : ",") + std::to_string(c);
    return text + (color->alpha ? "/" + std::to_string(*color->alpha) : "");
}

TEST(Channels, AColourIsFoundByNamesInAnyOrderOrByTheNumberOfUnnamedChannels) {
    EXPECT_EQ(colorOf(makeNamed({"R", "G", "B"})), "0,1,2");
    EXPECT_EQ(colorOf(makeNamed({"A", "B", "G", "R", "Z"})), "3,2,1/0");
    EXPECT_EQ(colorOf(makeNamed({"Y"})), "0");
    EXPECT_EQ(colorOf(makeNamed({"Y", "A"})), "0/1");
    EXPECT_EQ(colorOf(makeNamed({"Z", "beauty.R", "beauty.G", "beauty.B", "beauty.A"})), "1,2,3/4");
    EXPECT_EQ(colorOf(makeNamed({"spec.R", "spec.G", "spec.B", "R", "G", "B", "spec.A"})), "3,4,5")
        << "the layer without a name comes first, and another's alpha is not its own";
    EXPECT_EQ(colorOf(Image(1, 1, 1)), "0");
    EXPECT_EQ(colorOf(Image(1, 1, 2)), "0/1");
    EXPECT_EQ(colorOf(Image(1, 1, 3)), "0,1,2");
    EXPECT_EQ(colorOf(Image(1, 1, 4)), "0,1,2/3");
    EXPECT_EQ(colorOf(Image(1, 1, 5)), "-");
}

TEST(Channels, MotionDepthAndPartsOfAColourAreNone) {
    using Names = std::vector<std::string>;
    const Names kNone[] = {{"Z"}, {"R"}, {"A"}, {"R", "G"}, {"motion.x", "motion.y"}};
    for (const Names& names : kNone)
        EXPECT_EQ(colorOf(makeNamed(names)), "-") << names.front();
    const Names kThree[] = {{"N.x", "N.y", "N.z"}, {"P.X", "P.Y", "P.Z"}, {"a.R", "b.G", "c.B"}};
    for (const Names& names : kThree)
        EXPECT_EQ(colorOf(makeNamed(names)), "-") << names.front();
}

TEST(Channels, ChannelsArePickedWithTheirNames) {
    const Image picked = pickChannels(makeNamed({"A", "B", "C"}), std::array<uint32_t, 2>{2, 0});
    EXPECT_EQ(picked.channelNames, (std::vector<std::string>{"C", "A"}));
    EXPECT_EQ(picked.pixels, (std::vector<float>{2, 0, 5, 3}));
    EXPECT_EQ(listChannels(makeNamed({"A", "B"}), std::array<uint32_t, 2>{0, 1}), "A, B");
    EXPECT_EQ(listChannels(Image(1, 1, 2), std::array<uint32_t, 1>{1}), "1");
}

Plane makePlane(uint32_t width, uint32_t height) {
    Plane plane(width, height);
    for (size_t i = 0; i < plane.values.size(); ++i)
        plane.values[i] = float((i * 37 + i * i * 11) % 101);
    return plane;
}

/// The definition, one pixel.
float filterDirectly(const Plane& plane, const Kernel& kernel, int x, int y, int dx, int dy) {
    const int radius = int(kernel.size()) / 2;
    float sum = 0.0f;
    for (int o = -radius; o <= radius; ++o) {
        const int fromX = std::clamp(x + o * dx, 0, int(plane.width) - 1);
        const int fromY = std::clamp(y + o * dy, 0, int(plane.height) - 1);
        sum +=
            kernel[size_t(o + radius)] * plane.values[size_t(fromY) * plane.width + size_t(fromX)];
    }
    return sum;
}

TEST(Convolution, ConvolutionFollowsTheDefinitionForAllPictureSizes) {
    const Kernel kernel{0.5f, -1.0f, 3.0f, 2.0f, 0.25f};
    for (const uint32_t width : {1u, 2u, 5u, 13u})
        for (const uint32_t height : {1u, 3u, 9u}) {
            const Plane plane = makePlane(width, height);
            const Plane alongX = filterAlongX(plane, kernel);
            const Plane alongY = filterAlongY(plane, kernel);
            for (size_t i = 0; i < plane.values.size(); ++i) {
                const int x = int(i % width);
                const int y = int(i / width);
                EXPECT_EQ(alongX.values[i], filterDirectly(plane, kernel, x, y, 1, 0));
                EXPECT_EQ(alongY.values[i], filterDirectly(plane, kernel, x, y, 0, 1));
            }
        }
}

TEST(Convolution, ANanReachesTheKernelsRadiusAndAnEmptyPictureStaysEmpty) {
    Plane plane(9, 1);
    plane.values[4] = std::numeric_limits<float>::quiet_NaN();
    const Plane filtered = filterAlongX(plane, {0.0f, 1.0f, 0.0f});
    for (size_t x = 0; x < 9; ++x)
        EXPECT_EQ(std::isnan(filtered.values[x]), x >= 3 && x <= 5) << x;
    EXPECT_TRUE(filterAlongX(Plane(0, 4), {1.0f}).values.empty());
    EXPECT_TRUE(filterAlongY(Plane(4, 0), {1.0f}).values.empty());
}

TEST(ConvolutionDeathTest, AKernelNeedsAMiddle) {
    EXPECT_DEATH((void)filterAlongX(Plane(3, 3), {1.0f, 1.0f}), "2 weights");
    EXPECT_DEATH((void)filterAlongY(Plane(3, 3), {}), "0 weights");
}

} // namespace
} // namespace shutter::image
