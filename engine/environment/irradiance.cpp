// SPDX-License-Identifier: MIT
#include "engine/environment/irradiance.h"

#include "engine/environment/directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shutter::environment {

namespace {

using std::numbers::pi;

/// The polynomials that scene::Environment::irradiance has factors of.
template <class Vector> auto polynomials(const Vector& n) {
    using Real = typename Vector::value_type;
    return std::array<Real, 9>{
        Real(1),
        n.y,
        n.z,
        n.x,
        n.x * n.y,
        n.y * n.z,
        Real(3) * n.z * n.z - Real(1),
        n.x * n.z,
        n.x * n.x - n.y * n.y};
}

/// What makes each polynomial a harmonic of unit length, squared.
constexpr std::array<double, 9> kNormalisations = {
    1.0 / (4.0 * pi),
    3.0 / (4.0 * pi),
    3.0 / (4.0 * pi),
    3.0 / (4.0 * pi),
    15.0 / (4.0 * pi),
    15.0 / (4.0 * pi),
    5.0 / (16.0 * pi),
    15.0 / (4.0 * pi),
    15.0 / (16.0 * pi)};

/// Harmonics of the clamped cosine, over pi, by order (Ramamoorthi 2001, eq. 8).
constexpr std::array<double, 9> kCosine = {
    1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25};

} // namespace

std::array<math::vec3, 9> projectIrradiance(const image::Image& picture) {
    std::array<math::dvec3, 9> sums{};
    // A small picture has too few texels to tell the harmonics apart.
    const uint32_t width = std::max(picture.width, 64u);
    const uint32_t height = std::max(picture.height, 32u);
    for (uint32_t y = 0; y < height; ++y) {
        const double weight = texelSolidAngle(y, width, height);
        for (uint32_t x = 0; x < width; ++x) {
            const math::dvec3 direction = directionAt({(x + 0.5) / width, (y + 0.5) / height});
            const auto values = polynomials(direction);
            const math::dvec3 radiance(sampleDirection(picture, direction));
            for (size_t i = 0; i < sums.size(); ++i)
                sums[i] += weight * values[i] * radiance;
        }
    }
    std::array<math::vec3, 9> coefficients{};
    for (size_t i = 0; i < sums.size(); ++i)
        coefficients[i] = math::vec3(sums[i] * (kNormalisations[i] * kCosine[i]));
    return coefficients;
}

math::vec3 evaluateIrradiance(const std::array<math::vec3, 9>& coefficients, math::vec3 normal) {
    const auto values = polynomials(normal);
    math::vec3 sum(0.0f);
    for (size_t i = 0; i < values.size(); ++i)
        sum += coefficients[i] * values[i];
    return glm::max(sum, math::vec3(0.0f));
}

} // namespace shutter::environment
