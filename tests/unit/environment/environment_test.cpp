// SPDX-License-Identifier: MIT
// Pictures of all directions: cubes, skies, and the light that they give.
#include "engine/environment/directions.h"
#include "engine/environment/environment.h"
#include "engine/environment/image_based_light.h"
#include "engine/environment/sky_model.h"
#include "shaders/render/irradiance.glsl"
#include "tests/support/outcomes.h"

#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace shutter::environment {
namespace {

using math::dvec3;

image::Image makeGrey(uint32_t width, uint32_t height, uint32_t channels, float value) {
    image::Image picture(width, height, channels);
    for (float& v : picture.pixels)
        v = value;
    return picture;
}

TEST(Environment, InvalidEnvironmentsAreRefusedWithTheirNumbers) {
    const image::Image good = makeGrey(64, 32, 3, 1.0f);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(makeEnvironment(good, {}));
    test::expectRefused(makeEnvironment(makeGrey(64, 64, 3, 1.0f), {}), "64x64");
    test::expectRefused(makeEnvironment(makeGrey(4, 2, 3, 1.0f), {}), "4 pixels wide");
    test::expectRefused(makeEnvironment({}, {}), "0 pixels wide");
    test::expectRefused(makeEnvironment(good, {.intensity = -1.0}), "intensity");
    test::expectRefused(makeEnvironment(good, {.intensity = nan}), "intensity");
    test::expectRefused(makeEnvironment(good, {.rotationDegrees = nan}), "rotation");
    test::expectRefused(makeEnvironment(good, {.rotationDegrees = 400.0}), "400");
}

TEST(Environment, AnEnvironmentHasOnlyValuesThatHalfFloatsRepresent) {
    image::Image picture = makeGrey(64, 32, 4, 1.0f);
    picture.at(3, 3, 0) = std::numeric_limits<float>::quiet_NaN();
    picture.at(9, 3, 1) = std::numeric_limits<float>::infinity();
    picture.at(3, 9, 2) = -5.0f;
    picture.at(5, 9, 2) = -std::numeric_limits<float>::infinity();
    const auto made = test::valueOf(makeEnvironment(picture, {.intensity = 2.0}));
    const auto expectFinite = [](const scene::DirectionPicture& level) {
        ASSERT_EQ(level.rgba.size(), size_t(level.width) * level.height * 4);
        for (const uint16_t half : level.rgba) {
            const float value = glm::unpackHalf1x16(half);
            ASSERT_TRUE(std::isfinite(value));
            ASSERT_GE(value, 0.0f);
        }
    };
    for (const auto& level : made.background)
        expectFinite(level);
    for (const auto& level : made.mirrored)
        expectFinite(level);
    for (const math::vec3& factor : made.irradiance)
        for (int c = 0; c < 3; ++c)
            EXPECT_TRUE(std::isfinite(factor[c]));
    EXPECT_EQ(glm::unpackHalf1x16(made.background.front().rgba[0]), 2.0f);
}

TEST(Environment, AnEnvironmentOfZeroIntensityIsBlack) {
    image::Image picture = makeGrey(64, 32, 3, 1.0f);
    picture.at(9, 3, 1) = std::numeric_limits<float>::infinity();
    const auto made = test::valueOf(makeEnvironment(picture, {.intensity = 0.0}));
    const std::vector<uint16_t>& halves = made.background.front().rgba;
    for (size_t i = 0; i < halves.size(); ++i)
        ASSERT_EQ(glm::unpackHalf1x16(halves[i]), i % 4 == 3 ? 1.0f : 0.0f);
}

TEST(Environment, AnEnvironmentOfOneChannelIsGreyAndAPositiveRotationTurnsItToTheLeft) {
    const auto made =
        test::valueOf(makeEnvironment(makeGrey(64, 32, 1, 0.5f), {.rotationDegrees = 90.0}));
    const math::vec3 seen = evaluateIrradiance(made.irradiance, {0, 1, 0});
    EXPECT_LT(glm::distance(seen, math::vec3(0.5f)), 1e-3f);
    // The forward direction is now on the left: the map's middle is there.
    EXPECT_LT(glm::distance(made.mapFromWorld * math::vec3(-1, 0, 0), math::vec3(0, 0, -1)), 1e-6f);
}

TEST(Environment, AnEnvironmentHasAllLevelsAndFitsDevices) {
    // The narrowest that is too wide.
    constexpr uint32_t kWidth = kMaxWidth + 2;
    const auto made = test::valueOf(makeEnvironment(makeGrey(kWidth, kWidth / 2, 1, 0.5f), {}));
    const auto& levels = made.background;
    EXPECT_EQ(levels.front().width, kWidth / 2);
    ASSERT_EQ(levels.size(), 12u);
    for (size_t i = 1; i < levels.size(); ++i)
        EXPECT_EQ(levels[i].width, (kWidth / 2) >> i);
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

TEST(Directions, DirectionsAreThoseOfTheHeaderAndTexelsFillTheSphere) {
    const auto expectAt = [](math::dvec2 uv, dvec3 direction) {
        EXPECT_LT(glm::distance(directionAt(uv), direction), 1e-12) << uv.x << " " << uv.y;
    };
    expectAt({0.5, 0.5}, {0, 0, -1});
    expectAt({0.75, 0.5}, {1, 0, 0});
    expectAt({0.25, 0.5}, {-1, 0, 0});
    expectAt({0.0, 0.5}, {0, 0, 1});
    expectAt({0.3, 0.0}, {0, 1, 0});
    expectAt({0.3, 1.0}, {0, -1, 0});
    double sum = 0.0;
    for (uint32_t row = 0; row < 9; ++row)
        sum += 18 * texelSolidAngle(row, 18, 9);
    EXPECT_NEAR(sum, 4.0 * std::numbers::pi, 1e-12);
}

TEST(Directions, DirectionsAndPlacesAreInversesInShadersTooAndPolesHaveAPlace) {
    for (int i = 0; i < 40; ++i)
        for (int j = 1; j < 20; ++j) {
            const math::dvec2 uv((i + 0.5) / 40.0, j / 20.0);
            const dvec3 direction = directionAt(uv);
            EXPECT_LT(glm::distance(placeOf(direction), uv), 1e-9);
            const math::vec2 place = shader::equirectangularPlace(math::vec3(direction));
            EXPECT_LT(glm::distance(math::dvec2(place), uv), 1e-5);
        }
    for (const double y : {1.0, -1.0}) {
        const math::vec2 place = shader::equirectangularPlace(math::vec3(0, float(y), 0));
        EXPECT_FLOAT_EQ(place.x, 0.5f);
        EXPECT_FLOAT_EQ(place.y, y > 0 ? 0.0f : 1.0f);
        EXPECT_EQ(placeOf({0, y, 0}), math::dvec2(0.5, y > 0 ? 0.0 : 1.0));
    }
    // A length a little above 1, as rounding leaves it.
    EXPECT_EQ(shader::equirectangularPlace(math::vec3(0, 1.0000002f, 0)).y, 0.0f);
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

/// What a person inside the cube sees: forwards, right and up of each stored side.
struct View {
    dvec3 forward;
    dvec3 right;
    dvec3 up;
};

constexpr View kViews[6] = {
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}},
    {{0, -1, 0}, {-1, 0, 0}, {0, 0, 1}},
    {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
    {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}};

TEST(Cube, EachDirectionMapsToItsFace) {
    constexpr uint32_t kSize = 64;
    std::array<image::Image, 6> sides;
    for (size_t i = 0; i < 6; ++i) {
        sides[i] = image::Image(kSize, kSize, 3);
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x) {
                const dvec3 d = glm::normalize(
                    kViews[i].forward + kViews[i].right * ((x + 0.5) / kSize * 2.0 - 1.0) -
                    kViews[i].up * ((y + 0.5) / kSize * 2.0 - 1.0)
                );
                for (int c = 0; c < 3; ++c)
                    sides[i].at(x, y, uint32_t(c)) = float(d[c]);
            }
    }
    const image::Image picture = unwrapCube(sides, 128);
    ASSERT_EQ(picture.height, 64u);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 128; ++x) {
            const dvec3 expected = directionAt({(x + 0.5) / 128.0, (y + 0.5) / 64.0});
            for (int c = 0; c < 3; ++c)
                // Half a texel of a side is lost at its border.
                ASSERT_NEAR(picture.at(x, y, uint32_t(c)), expected[c], 0.02) << x << " " << y;
        }
}

dvec3 sunAt(double elevationDegrees) {
    const double e = glm::radians(elevationDegrees);
    return {0.0, std::sin(e), -std::cos(e)};
}

double luminanceOf(math::vec3 c) {
    return glm::dot(c, math::vec3(0.2126f, 0.7152f, 0.0722f));
}

TEST(SkyModel, RadianceIsFiniteAndNotNegativeForEverySunAndHaze) {
    for (const double turbidity : {kMinTurbidity, 2.5, 6.0, kMaxTurbidity})
        for (const double elevation : {-90.0, -20.0, 0.0, 0.5, 5.0, 45.0, 89.9, 90.0}) {
            const Sky sky({.turbidity = turbidity, .toSun = sunAt(elevation)});
            for (int i = 0; i < 400; ++i) {
                const math::vec3 seen =
                    sky.radianceOf(directionAt({(i % 20) / 20.0, (i / 20) / 19.0}));
                for (int c = 0; c < 3; ++c) {
                    ASSERT_TRUE(std::isfinite(seen[c])) << turbidity << " " << elevation;
                    ASSERT_GE(seen[c], 0.0f) << turbidity << " " << elevation;
                }
            }
            EXPECT_TRUE(std::isfinite(sky.discRadiance().x));
        }
}

TEST(SkyModel, ZenithLuminanceIsThatOfTheSource) {
    // Preetham 1999, A.2, by hand: T = 3, the sun 45 degrees high.
    const double chi = (4.0 / 9.0 - 3.0 / 120.0) * (std::numbers::pi / 2.0);
    const double kcd = (4.0453 * 3.0 - 4.9710) * std::tan(chi) - 0.2155 * 3.0 + 2.4192;
    const double klx = 127.5 * std::exp(-0.21 * std::numbers::sqrt2);
    const Sky sky({.turbidity = 3.0, .toSun = sunAt(45.0), .sunIlluminance = math::vec3(2.0f)});
    EXPECT_NEAR(luminanceOf(sky.radianceOf({0, 1, 0})), kcd / klx * 2.0, 2e-3);
}

TEST(SkyModel, TheSkysRatioToItsSunIsPhysical) {
    const Sky one({.toSun = sunAt(40.0), .sunIlluminance = math::vec3(1.0f)});
    const Sky three({.toSun = sunAt(40.0), .sunIlluminance = math::vec3(3.0f)});
    for (const dvec3& d : {dvec3(0, 1, 0), dvec3(1, 0, 0), dvec3(0, -1, 0)})
        EXPECT_LT(glm::distance(3.0f * one.radianceOf(d), three.radianceOf(d)), 1e-4f);
    const Sky dark({.toSun = sunAt(40.0), .sunIlluminance = math::vec3(0.0f)});
    EXPECT_EQ(dark.radianceOf({0, 1, 0}), math::vec3(0.0f));
    EXPECT_EQ(dark.discRadiance(), math::vec3(0.0f));
}

TEST(SkyModel, TheSkyIsBlueAwayFromTheSunBrightestNextToItAndLightsTheGroundByAClearDaysShare) {
    const Sky sky({.toSun = sunAt(50.0)});
    const math::vec3 away = sky.radianceOf(glm::normalize(dvec3(0, 1, 0.7)));
    EXPECT_GT(away.z, 1.5f * away.x);
    EXPECT_GT(luminanceOf(sky.radianceOf(sunAt(50.0))), 3.0 * luminanceOf(away));
    // Outside, a clear sky gives a fifth to a tenth of what the sun gives: 10 to 20 klx of 100.
    double sum = 0.0;
    for (uint32_t y = 0; y < 45; ++y)
        for (uint32_t x = 0; x < 180; ++x) {
            const dvec3 d = directionAt({(x + 0.5) / 180.0, (y + 0.5) / 90.0});
            sum += luminanceOf(sky.radianceOf(d)) * d.y * texelSolidAngle(y, 180, 90);
        }
    EXPECT_GT(sum, 0.08);
    EXPECT_LT(sum, 0.3);
}

TEST(SkyModel, TheSunIsDrawnAtItsPlaceInTheBackgroundOnly) {
    const SkySettings settings{.toSun = glm::normalize(dvec3(0.4, 0.5, -0.6))};
    const SkyPictures pictures = drawSky(settings, 1024);
    EXPECT_EQ(pictures.light.width, 256u);
    uint32_t differing = 0;
    for (uint32_t y = 0; y < 512; ++y)
        for (uint32_t x = 0; x < 1024; ++x) {
            const dvec3 d = directionAt({(x + 0.5) / 1024.0, (y + 0.5) / 512.0});
            const float light = sampleDirection(pictures.light, d).y;
            if (light == pictures.background.at(x, y, 1))
                continue;
            ++differing;
            EXPECT_GT(glm::dot(d, settings.toSun), std::cos(0.02));
            EXPECT_GT(pictures.background.at(x, y, 1), light);
        }
    EXPECT_GE(differing, 1u);
    EXPECT_LE(differing, 16u);
}

/// \param radiance of a direction: a colour, or a number for grey
template <class Radiance> image::Image draw(uint32_t width, const Radiance& radiance) {
    image::Image picture(width, width / 2, 3);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const dvec3 color(radiance(directionAt({(x + 0.5) / width, (y + 0.5) / picture.height}))
            );
            for (int c = 0; c < 3; ++c)
                picture.at(x, y, uint32_t(c)) = float(color[c]);
        }
    return picture;
}

/// Irradiance over pi by its definition.
dvec3 integrate(const image::Image& picture, dvec3 normal) {
    dvec3 sum(0.0);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const dvec3 d = directionAt({(x + 0.5) / picture.width, (y + 0.5) / picture.height});
            const double weight = texelSolidAngle(y, picture.width, picture.height) *
                                  std::max(glm::dot(d, normal), 0.0) / std::numbers::pi;
            sum += weight * dvec3(picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2));
        }
    return sum;
}

const dvec3 kNormals[] = {
    {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {0.6, 0.48, 0.64}};

TEST(
    Irradiance,
    IrradianceIsThatOfOneColourTheIntegralOfSmoothLightAndErrsByThreePercentForAHalfSphere
) {
    const auto factors = projectIrradiance(draw(64, [](dvec3) { return dvec3(0.2, 0.5, 3.0); }));
    for (const dvec3& n : kNormals) {
        const math::vec3 seen = evaluateIrradiance(factors, math::vec3(n));
        EXPECT_NEAR(seen.x, 0.2, 2e-4); // 64 texels round the horizon
        EXPECT_NEAR(seen.y, 0.5, 5e-4);
        EXPECT_NEAR(seen.z, 3.0, 3e-3);
    }
    // Second order: the harmonics hold it exactly.
    const image::Image smooth = draw(128, [](dvec3 d) {
        return dvec3(1.0 + d.y, 2.0 + d.x * d.z + d.x, 1.5 + d.z * d.z - d.x * d.y);
    });
    const auto ofSmooth = projectIrradiance(smooth);
    for (const dvec3& n : kNormals)
        EXPECT_LT(
            glm::distance(dvec3(evaluateIrradiance(ofSmooth, math::vec3(n))), integrate(smooth, n)),
            3e-3
        );
    // What Ramamoorthi 2001 allows for: 9 % at worst, far less on average.
    const image::Image half = draw(128, [](dvec3 d) { return dvec3(d.x > 0.0 ? 1.0 : 0.0); });
    const auto ofHalf = projectIrradiance(half);
    for (const dvec3& n : kNormals)
        EXPECT_NEAR(evaluateIrradiance(ofHalf, math::vec3(n)).x, integrate(half, n).x, 0.035);
}

TEST(Irradiance, IrradianceIsNeverNegativeAndTheShadersAgree) {
    const image::Image picture = draw(128, [](dvec3 d) { return dvec3(d.y > 0.98 ? 40.0 : 0.0); });
    const auto factors = projectIrradiance(picture);
    math::vec4 packed[9];
    for (int i = 0; i < 9; ++i)
        packed[i] = math::vec4(factors[size_t(i)], 0.0f);
    bool clamped = false;
    for (int i = 0; i < 50; ++i) {
        const math::vec3 n(directionAt({i / 50.0, (i * 11 % 50) / 50.0}));
        const math::vec3 seen = evaluateIrradiance(factors, n);
        clamped = clamped || seen.x == 0.0f;
        EXPECT_GE(seen.x, 0.0f);
        EXPECT_LT(glm::distance(shader::evaluateIrradiance(packed, n), seen), 1e-4f);
    }
    EXPECT_TRUE(clamped) << "nothing here would be negative without the guard";
}

/// Karis 2013 by the sum over all texels: light l about n = v = r, weighted by GGX's distribution
/// of the half vector (as the density of l) and by n.l.
double integrate(const image::Image& picture, dvec3 axis, double roughness) {
    const double alpha2 = std::pow(roughness, 4.0);
    double sum = 0.0;
    double weights = 0.0;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const dvec3 l = directionAt({(x + 0.5) / picture.width, (y + 0.5) / picture.height});
            const double cosine = glm::dot(l, axis);
            if (cosine <= 0.0)
                continue;
            const double nDotH = glm::dot(glm::normalize(l + axis), axis);
            const double d = nDotH * nDotH * (alpha2 - 1.0) + 1.0;
            // D nDotH / (4 vDotH), and v = n.
            const double weight =
                alpha2 / (d * d) * cosine * texelSolidAngle(y, picture.width, picture.height);
            sum += weight * picture.at(x, y, 0);
            weights += weight;
        }
    return sum / weights;
}

TEST(Prefilter, EachLevelIsHalfAsWideDownToTheRoughestFromTheLimitAndASmallPictureStaysAsItIs) {
    const auto levels = prefilterMirrored(draw(512, [](dvec3) { return 2.0; }));
    ASSERT_EQ(levels.size(), 5u);
    for (size_t i = 0; i < levels.size(); ++i) {
        EXPECT_EQ(levels[i].width, 512u >> i);
        EXPECT_EQ(levels[i].height, 256u >> i);
        for (const float value : levels[i].pixels)
            ASSERT_NEAR(value, 2.0f, 1e-4f) << i;
    }
    EXPECT_EQ(
        prefilterMirrored(draw(2 * kMirrorWidth, [](dvec3) { return 1.0; })).front().width,
        kMirrorWidth
    );
    const auto small = prefilterMirrored(draw(8, [](dvec3 d) { return 1.0 + d.y; }));
    ASSERT_EQ(small.size(), 1u);
    EXPECT_EQ(small.front().width, 8u);
}

TEST(Prefilter, PrefilteredLightIsTheIntegralOverGgx) {
    const image::Image picture = draw(256, [](dvec3 d) {
        return 1.0 + (d.x > 0.3 ? 2.0 : 0.0) + std::max(d.y, 0.0) * (d.z < 0.0 ? 1.0 : 0.2);
    });
    const auto levels = prefilterMirrored(picture);
    ASSERT_EQ(levels.size(), 4u);
    for (size_t i = 1; i < levels.size(); ++i)
        for (int k = 0; k < 24; ++k) {
            const math::dvec2 uv((k + 0.5) / 24.0, ((k * 5) % 24 + 0.5) / 24.0);
            const dvec3 axis = directionAt(uv);
            EXPECT_NEAR(
                sampleDirection(levels[i], axis).x, integrate(picture, axis, double(i) / 3.0), 0.16
            ) << "level "
              << i << " place " << k;
        }
}

TEST(Prefilter, APoleShowsNoSeam) {
    // The roughest level around the pole: all its columns must agree.
    const auto levels =
        prefilterMirrored(draw(256, [](dvec3 d) { return 1.0 + (d.x > 0.0 ? 1.0 : 0.0); }));
    const image::Image& roughest = levels.back();
    for (uint32_t x = 0; x < roughest.width; ++x)
        EXPECT_NEAR(roughest.at(x, 0, 0), 1.5, 0.12) << x;
}

} // namespace
} // namespace shutter::environment
