// SPDX-License-Identifier: MIT
#include "modules/tonemap/tonemap.h"
#include "shaders/tonemap/tonemap.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace shutter::tonemap {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

image::Image makeImage(uint32_t channels, const std::vector<float>& values) {
    image::Image image(uint32_t(values.size()) / channels, 1, channels);
    image.pixels = values;
    return image;
}

TEST(Display, TheDisplayIsTheShadersOperatorAfterTheGain) {
    const image::Image linear = makeImage(3, {0.1f, 0.2f, 0.3f, 5.0f, 0.0f, 1.0f});
    for (const Operator op : {Operator::None, Operator::Neutral})
        for (const double stops : {0.0, -2.0, 3.0}) {
            const image::Image display = computeDisplayImage(linear, {op, stops});
            for (size_t i = 0; i < linear.pixels.size(); i += 3) {
                glm::vec3 color(linear.pixels[i], linear.pixels[i + 1], linear.pixels[i + 2]);
                color *= std::exp2(float(stops));
                if (op == Operator::Neutral)
                    color = shader::toneMapNeutral(color);
                for (int c = 0; c < 3; ++c)
                    EXPECT_EQ(display.pixels[i + size_t(c)], shader::encodeSrgb(color[c]));
            }
        }
}

TEST(Display, AnImageOfOneChannelIsGrey) {
    const image::Image grey = computeDisplayImage(makeImage(1, {0.3f, 4.0f}), {});
    const image::Image color =
        computeDisplayImage(makeImage(3, {0.3f, 0.3f, 0.3f, 4.0f, 4.0f, 4.0f}), {});
    ASSERT_EQ(grey.pixels.size(), 2u);
    EXPECT_EQ(grey.pixels[0], color.pixels[0]);
    EXPECT_EQ(grey.pixels[1], color.pixels[3]);
}

TEST(Display, InfiniteLightIsWhiteAndLightBelowZeroBlack) {
    for (const Operator op : {Operator::None, Operator::Neutral})
        for (const double stops : {0.0, 32.0, -32.0}) {
            const image::Image display = computeDisplayImage(
                makeImage(1, {kInfinity, -kInfinity, -1.0f, 0.0f}), {op, stops}
            );
            EXPECT_NEAR(display.pixels[0], 1.0f, 1e-3f) << stops;
            for (size_t i = 1; i < 4; ++i)
                EXPECT_EQ(display.pixels[i], 0.0f) << i;
        }
}

TEST(Display, ANanStaysOneInEveryChannelOfItsPixelAlone) {
    for (const Operator op : {Operator::None, Operator::Neutral})
        for (size_t at = 0; at < 3; ++at) {
            image::Image linear = makeImage(3, {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f});
            linear.pixels[at] = kNan;
            const image::Image display = computeDisplayImage(linear, {op, 0.0});
            for (size_t i = 0; i < 6; ++i)
                EXPECT_EQ(std::isnan(display.pixels[i]), i < 3) << at << " " << i;
        }
}

TEST(DisplayDeathTest, MotionIsNoColour) {
    EXPECT_DEATH((void)computeDisplayImage(makeImage(2, {0.0f, 0.0f}), {}), "2 channels");
}

} // namespace
} // namespace shutter::tonemap
