// SPDX-License-Identifier: MIT
#include "engine/environment/directions.h"
#include "engine/environment/environment.h"
#include "engine/environment/irradiance.h"

#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace shutter::environment {
namespace {

image::Image makeGrey(uint32_t width, uint32_t height, uint32_t channels, float value) {
    image::Image picture(width, height, channels);
    for (float& v : picture.pixels)
        v = value;
    return picture;
}

TEST(Environment, IsRefusedWithItsNumbers) {
    const auto messageOf = [](const image::Image& picture, const EnvironmentSettings& settings) {
        const auto made = makeEnvironment(picture, settings);
        return made ? std::string() : made.error().message;
    };
    const image::Image good = makeGrey(64, 32, 3, 1.0f);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(messageOf(good, {}), "");
    EXPECT_NE(messageOf(makeGrey(64, 64, 3, 1.0f), {}).find("64x64"), std::string::npos);
    EXPECT_NE(messageOf(makeGrey(4, 2, 3, 1.0f), {}).find("4 pixels wide"), std::string::npos);
    EXPECT_NE(messageOf({}, {}).find("0 pixels wide"), std::string::npos);
    EXPECT_NE(messageOf(good, {.intensity = -1.0}).find("intensity"), std::string::npos);
    EXPECT_NE(messageOf(good, {.intensity = nan}).find("intensity"), std::string::npos);
    EXPECT_NE(messageOf(good, {.rotationDegrees = nan}).find("rotation"), std::string::npos);
    EXPECT_NE(messageOf(good, {.rotationDegrees = 400.0}).find("400"), std::string::npos);
}

TEST(Environment, HoldsNothingButNumbersThatHalfFloatsHold) {
    image::Image picture = makeGrey(64, 32, 4, 1.0f);
    picture.at(3, 3, 0) = std::numeric_limits<float>::quiet_NaN();
    picture.at(9, 3, 1) = std::numeric_limits<float>::infinity();
    picture.at(3, 9, 2) = -5.0f;
    picture.at(5, 9, 2) = -std::numeric_limits<float>::infinity();
    const auto made = makeEnvironment(picture, {.intensity = 2.0});
    ASSERT_TRUE(made);
    const auto expectFinite = [](const scene::DirectionPicture& level) {
        ASSERT_EQ(level.rgba.size(), size_t(level.width) * level.height * 4);
        for (const uint16_t half : level.rgba) {
            const float value = glm::unpackHalf1x16(half);
            ASSERT_TRUE(std::isfinite(value));
            ASSERT_GE(value, 0.0f);
        }
    };
    for (const auto& level : made.value().background)
        expectFinite(level);
    for (const auto& level : made.value().mirrored)
        expectFinite(level);
    for (const math::vec3& factor : made.value().irradiance)
        for (int c = 0; c < 3; ++c)
            EXPECT_TRUE(std::isfinite(factor[c]));
    EXPECT_EQ(glm::unpackHalf1x16(made.value().background.front().rgba[0]), 2.0f);
}

TEST(Environment, IsBlackAtNoIntensityWhateverItsPictureHolds) {
    image::Image picture = makeGrey(64, 32, 3, 1.0f);
    picture.at(9, 3, 1) = std::numeric_limits<float>::infinity();
    const auto made = makeEnvironment(picture, {.intensity = 0.0});
    ASSERT_TRUE(made);
    const std::vector<uint16_t>& halves = made.value().background.front().rgba;
    for (size_t i = 0; i < halves.size(); ++i)
        ASSERT_EQ(glm::unpackHalf1x16(halves[i]), i % 4 == 3 ? 1.0f : 0.0f);
}

TEST(Environment, OfOneChannelIsGrey) {
    const auto made = makeEnvironment(makeGrey(64, 32, 1, 0.5f), {});
    ASSERT_TRUE(made);
    const math::vec3 seen = evaluateIrradiance(made.value().irradiance, {0, 1, 0});
    EXPECT_LT(glm::distance(seen, math::vec3(0.5f)), 1e-3f);
}

TEST(Environment, HasEveryLevelOfItsBackgroundAndIsNoWiderThanDevicesTake) {
    const auto made = makeEnvironment(makeGrey(kMostWidth * 2, kMostWidth, 1, 0.5f), {});
    ASSERT_TRUE(made);
    const auto& levels = made.value().background;
    EXPECT_EQ(levels.front().width, kMostWidth);
    ASSERT_EQ(levels.size(), 13u);
    for (size_t i = 1; i < levels.size(); ++i)
        EXPECT_EQ(levels[i].width, kMostWidth >> i);
}

TEST(Environment, APositiveRotationTurnsItToTheLeft) {
    const auto made = makeEnvironment(makeGrey(64, 32, 1, 0.5f), {.rotationDegrees = 90.0});
    ASSERT_TRUE(made);
    // What lay ahead now lies on the left: there the map's middle is looked up.
    const math::vec3 looked = made.value().mapFromWorld * math::vec3(-1, 0, 0);
    EXPECT_LT(glm::distance(looked, math::vec3(0, 0, -1)), 1e-6f);
}

TEST(Environment, ASkysSunIsNotAmongWhatLights) {
    const scene::Environment sky = makeSky({.toSun = {0, 1, 0}, .sunIlluminance = math::vec3(3)});
    float brightest = 0.0f;
    for (const uint16_t half : sky.background.front().rgba)
        brightest = std::max(brightest, glm::unpackHalf1x16(half));
    float mirrored = 0.0f;
    for (const uint16_t half : sky.mirrored.front().rgba)
        mirrored = std::max(mirrored, glm::unpackHalf1x16(half));
    EXPECT_GT(brightest, 50.0f * mirrored);
}

} // namespace
} // namespace shutter::environment
