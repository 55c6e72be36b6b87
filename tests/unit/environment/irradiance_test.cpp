// SPDX-License-Identifier: MIT
#include "engine/environment/directions.h"
#include "engine/environment/irradiance.h"
#include "shaders/render/irradiance.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace shutter::environment {
namespace {

using math::dvec3;

template <class Radiance> image::Image draw(uint32_t width, const Radiance& radiance) {
    image::Image picture(width, width / 2, 3);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const math::vec3 color(
                radiance(directionAt({(x + 0.5) / width, (y + 0.5) / picture.height}))
            );
            for (int c = 0; c < 3; ++c)
                picture.at(x, y, uint32_t(c)) = color[c];
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

TEST(Irradiance, OfOneColourIsThatColour) {
    const auto factors = projectIrradiance(draw(64, [](dvec3) { return dvec3(0.2, 0.5, 3.0); }));
    for (const dvec3& n : kNormals) {
        const math::vec3 seen = evaluateIrradiance(factors, math::vec3(n));
        EXPECT_NEAR(seen.x, 0.2, 2e-4); // 64 texels round the horizon
        EXPECT_NEAR(seen.y, 0.5, 5e-4);
        EXPECT_NEAR(seen.z, 3.0, 3e-3);
    }
}

TEST(Irradiance, OfSmoothLightIsItsIntegral) {
    // Second order: the harmonics hold it exactly.
    const image::Image picture = draw(128, [](dvec3 d) {
        return dvec3(1.0 + d.y, 2.0 + d.x * d.z + d.x, 1.5 + d.z * d.z - d.x * d.y);
    });
    const auto factors = projectIrradiance(picture);
    for (const dvec3& n : kNormals)
        EXPECT_LT(
            glm::distance(dvec3(evaluateIrradiance(factors, math::vec3(n))), integrate(picture, n)),
            3e-3
        );
}

TEST(Irradiance, OfAHalfSphereErrsByThreePercentOfItsLight) {
    // What Ramamoorthi 2001 allows for: 9 % at worst, far less on average.
    const image::Image picture = draw(128, [](dvec3 d) { return dvec3(d.x > 0.0 ? 1.0 : 0.0); });
    const auto factors = projectIrradiance(picture);
    for (const dvec3& n : kNormals)
        EXPECT_NEAR(evaluateIrradiance(factors, math::vec3(n)).x, integrate(picture, n).x, 0.035);
}

TEST(Irradiance, IsNeverNegativeAndTheShadersAgree) {
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

} // namespace
} // namespace shutter::environment
