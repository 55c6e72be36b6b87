// SPDX-License-Identifier: MIT
#include "engine/environment/directions.h"
#include "engine/environment/sky_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace shutter::environment {
namespace {

using math::dvec3;

dvec3 sunAt(double elevationDegrees) {
    const double e = glm::radians(elevationDegrees);
    return {0.0, std::sin(e), -std::cos(e)};
}

double luminanceOf(math::vec3 c) {
    return glm::dot(c, math::vec3(0.2126f, 0.7152f, 0.0722f));
}

TEST(SkyModel, IsFiniteAndNotNegativeForEverySunAndHaze) {
    for (const double turbidity : {kLeastTurbidity, 2.5, 6.0, kMostTurbidity})
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

TEST(SkyModel, HasTheZenithLuminanceOfItsSource) {
    // Preetham 1999, A.2, by hand: T = 3, the sun 45 degrees high.
    const double chi = (4.0 / 9.0 - 3.0 / 120.0) * (std::numbers::pi / 2.0);
    const double kcd = (4.0453 * 3.0 - 4.9710) * std::tan(chi) - 0.2155 * 3.0 + 2.4192;
    const double klx = 127.5 * std::exp(-0.21 * std::numbers::sqrt2);
    const Sky sky({.turbidity = 3.0, .toSun = sunAt(45.0), .sunIlluminance = math::vec3(2.0f)});
    EXPECT_NEAR(luminanceOf(sky.radianceOf({0, 1, 0})), kcd / klx * 2.0, 2e-3);
}

TEST(SkyModel, StandsInProportionToItsSun) {
    const Sky one({.toSun = sunAt(40.0), .sunIlluminance = math::vec3(1.0f)});
    const Sky three({.toSun = sunAt(40.0), .sunIlluminance = math::vec3(3.0f)});
    for (const dvec3& d : {dvec3(0, 1, 0), dvec3(1, 0, 0), dvec3(0, -1, 0)})
        EXPECT_LT(glm::distance(3.0f * one.radianceOf(d), three.radianceOf(d)), 1e-4f);
    const Sky dark({.toSun = sunAt(40.0), .sunIlluminance = math::vec3(0.0f)});
    EXPECT_EQ(dark.radianceOf({0, 1, 0}), math::vec3(0.0f));
    EXPECT_EQ(dark.discRadiance(), math::vec3(0.0f));
}

TEST(SkyModel, IsBlueAwayFromTheSunAndBrightestBesideIt) {
    const Sky sky({.toSun = sunAt(50.0)});
    const math::vec3 away = sky.radianceOf(glm::normalize(dvec3(0, 1, 0.7)));
    EXPECT_GT(away.z, 1.5f * away.x);
    EXPECT_GT(luminanceOf(sky.radianceOf(sunAt(50.0))), 3.0 * luminanceOf(away));
}

TEST(SkyModel, LightsAHorizontalSurfaceByAClearDaysShare) {
    // Outside, a clear sky gives a fifth to a tenth of what the sun gives: 10 to 20 klx of 100.
    const Sky sky({.toSun = sunAt(50.0)});
    double sum = 0.0;
    for (uint32_t y = 0; y < 45; ++y)
        for (uint32_t x = 0; x < 180; ++x) {
            const dvec3 d = directionAt({(x + 0.5) / 180.0, (y + 0.5) / 90.0});
            sum += luminanceOf(sky.radianceOf(d)) * d.y * texelSolidAngle(y, 180, 90);
        }
    EXPECT_GT(sum, 0.08);
    EXPECT_LT(sum, 0.3);
}

TEST(SkyModel, DrawsTheSunWhereItIsInTheBackgroundAlone) {
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

} // namespace
} // namespace shutter::environment
