// SPDX-License-Identifier: MIT
#include "engine/environment/directions.h"
#include "shaders/render/irradiance.glsl"

#include <gtest/gtest.h>

#include <numbers>

namespace shutter::environment {
namespace {

using math::dvec3;

TEST(Directions, AreWhereTheHeaderSays) {
    const auto expectAt = [](math::dvec2 uv, dvec3 direction) {
        EXPECT_LT(glm::distance(directionAt(uv), direction), 1e-12) << uv.x << " " << uv.y;
    };
    expectAt({0.5, 0.5}, {0, 0, -1});
    expectAt({0.75, 0.5}, {1, 0, 0});
    expectAt({0.25, 0.5}, {-1, 0, 0});
    expectAt({0.0, 0.5}, {0, 0, 1});
    expectAt({0.3, 0.0}, {0, 1, 0});
    expectAt({0.3, 1.0}, {0, -1, 0});
}

TEST(Directions, AndPlacesAreInversesInShadersToo) {
    for (int i = 0; i < 40; ++i)
        for (int j = 1; j < 20; ++j) {
            const math::dvec2 uv((i + 0.5) / 40.0, j / 20.0);
            const dvec3 direction = directionAt(uv);
            EXPECT_LT(glm::distance(placeOf(direction), uv), 1e-9);
            const math::vec2 place = shader::equirectangularPlace(math::vec3(direction));
            EXPECT_LT(glm::distance(math::dvec2(place), uv), 1e-5);
        }
}

TEST(Directions, OfThePolesHaveAPlace) {
    for (const double y : {1.0, -1.0}) {
        const math::vec2 place = shader::equirectangularPlace(math::vec3(0, float(y), 0));
        EXPECT_FLOAT_EQ(place.x, 0.5f);
        EXPECT_FLOAT_EQ(place.y, y > 0 ? 0.0f : 1.0f);
        EXPECT_EQ(placeOf({0, y, 0}), math::dvec2(0.5, y > 0 ? 0.0 : 1.0));
    }
    // A length a little above 1, as rounding leaves it.
    EXPECT_EQ(shader::equirectangularPlace(math::vec3(0, 1.0000002f, 0)).y, 0.0f);
}

TEST(Directions, TexelsFillTheSphere) {
    double sum = 0.0;
    for (uint32_t row = 0; row < 9; ++row)
        sum += 18 * texelSolidAngle(row, 18, 9);
    EXPECT_NEAR(sum, 4.0 * std::numbers::pi, 1e-12);
}

image::Image makeRamp(uint32_t width) {
    image::Image picture(width, width / 2, 3);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const dvec3 d = directionAt({(x + 0.5) / width, (y + 0.5) / picture.height});
            for (int c = 0; c < 3; ++c)
                picture.at(x, y, uint32_t(c)) = float(1.0 + d[c]);
        }
    return picture;
}

TEST(Directions, ThePictureIsLookedUpRoundTheHorizonAndUpToThePoles) {
    const image::Image picture = makeRamp(64);
    for (int i = 0; i <= 200; ++i) {
        const dvec3 direction = directionAt({i / 200.0, (i * 7 % 201) / 200.0});
        EXPECT_LT(
            glm::distance(dvec3(sampleDirection(picture, direction)), dvec3(1.0) + direction), 0.06
        ) << i;
    }
}

TEST(Directions, HalvesKeepTheMeanBySolidAngle) {
    const auto meanOf = [](const image::Image& picture) {
        double sum = 0.0;
        for (uint32_t y = 0; y < picture.height; ++y)
            for (uint32_t x = 0; x < picture.width; ++x)
                sum += texelSolidAngle(y, picture.width, picture.height) * picture.at(x, y, 1);
        return sum;
    };
    for (const uint32_t width : {64u, 20u, 2u}) {
        const image::Image picture = makeRamp(width);
        const std::vector<image::Image> pyramid = makePyramid(picture, 1);
        EXPECT_EQ(pyramid.back().width, 1u);
        EXPECT_EQ(pyramid.back().height, 1u);
        if (width == 64) {
            EXPECT_NEAR(meanOf(pyramid[3]), meanOf(picture), 1e-4);
        }
    }
}

} // namespace
} // namespace shutter::environment
