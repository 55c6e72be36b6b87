// SPDX-License-Identifier: MIT
#include "engine/environment/image_based_light.h"

#include "engine/core/parallel_jobs.h"
#include "engine/environment/directions.h"
#include "engine/math/sampling.h"

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

using std::numbers::pi;

/// For the first filtered level; each level above has a quarter of the texels and takes twice as
/// many.
constexpr uint32_t kSamples = 64;
constexpr uint32_t kMaxSamples = 512;

/// A direction of light about the axis of what mirrors it.
struct LobeSample {
    math::dvec3 direction{0.0}; ///< z: the axis
    double weight = 0.0;        ///< its cosine
    double solidAngle = 0.0;    ///< of the texel, steradians
};

/// \param roughness perceptual, (0, 1]
std::vector<LobeSample> listSamples(double roughness, uint32_t count) {
    const double alpha = roughness * roughness;
    const double alpha2 = alpha * alpha;
    std::vector<LobeSample> samples;
    for (uint32_t i = 0; i < count; ++i) {
        const math::dvec2 place((i + 0.5) / count, math::radicalInverse(i, 2));
        const double azimuth = 2.0 * pi * place.y;
        const double cos2 = (1.0 - place.x) / (1.0 + (alpha2 - 1.0) * place.x);
        const double cosH = std::sqrt(cos2);
        const double sinH = std::sqrt(std::max(1.0 - cos2, 0.0));
        // Mirrored at the half vector, of the axis itself: n = v.
        LobeSample sample;
        sample.direction = {
            2.0 * cosH * sinH * std::cos(azimuth),
            2.0 * cosH * sinH * std::sin(azimuth),
            2.0 * cos2 - 1.0};
        sample.weight = sample.direction.z;
        if (sample.weight <= 0.0)
            continue;
        const double d = cos2 * (alpha2 - 1.0) + 1.0;
        const double density = alpha2 / (pi * d * d) / 4.0; // D cosH / (4 vDotH), with v = n
        sample.solidAngle = 1.0 / (count * density);
        samples.push_back(sample);
    }
    return samples;
}

/// Unit vectors that make a right-handed frame with the unit axis (Duff et al. 2017).
void makeFrame(math::dvec3 axis, math::dvec3& across, math::dvec3& along) {
    const double sign = std::copysign(1.0, axis.z);
    const double a = -1.0 / (sign + axis.z);
    const double b = axis.x * axis.y * a;
    across = {1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
    along = {b, sign + axis.y * axis.y * a, -axis.y};
}

math::vec3 filterLobe(
    const std::vector<image::Image>& pyramid,
    const std::vector<LobeSample>& samples,
    math::dvec3 axis
) {
    math::dvec3 across;
    math::dvec3 along;
    makeFrame(axis, across, along);
    const image::Image& finest = pyramid.front();
    // The texels round the horizon are the largest: nearer the poles this takes a level too coarse
    // in u, whose texels are the closer there.
    const double texel = 2.0 * pi / finest.width * pi / finest.height;
    math::dvec3 sum(0.0);
    double weights = 0.0;
    for (const LobeSample& sample : samples) {
        const math::dvec3 direction =
            across * sample.direction.x + along * sample.direction.y + axis * sample.direction.z;
        // One level more than Krivanek's: neighbours overlap, so that no grain is left.
        const double level = 0.5 * std::log2(sample.solidAngle / texel) + 1.0;
        sum += sample.weight * math::dvec3(samplePyramid(pyramid, direction, level));
        weights += sample.weight;
    }
    return math::vec3(sum / weights);
}

image::Image filterAll(
    const std::vector<image::Image>& pyramid, const std::vector<LobeSample>& samples, uint32_t width
) {
    image::Image filtered(width, width / 2, 3);
    core::runParallelJobs(filtered.height, [&](size_t row) {
        const auto y = uint32_t(row);
        for (uint32_t x = 0; x < width; ++x) {
            const math::vec3 color = filterLobe(
                pyramid, samples, directionAt({(x + 0.5) / width, (y + 0.5) / filtered.height})
            );
            for (uint32_t c = 0; c < 3; ++c)
                filtered.at(x, y, c) = color[static_cast<int>(c)];
        }
    });
    return filtered;
}

} // namespace

std::array<math::vec3, 9> projectIrradiance(const image::Image& picture) {
    std::array<math::dvec3, 9> sums{};
    // A small picture has too few texels to resolve the harmonics.
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

std::vector<image::Image> prefilterMirrored(const image::Image& picture) {
    const std::vector<image::Image> pyramid = makePyramid(picture, 2);
    // The first is no wider than the picture, and each is half as wide as the one before.
    size_t first = 0;
    while (first + 1 < pyramid.size() && pyramid[first].width > kMirrorWidth)
        ++first;
    std::vector<image::Image> mirrored{pyramid[first]};
    uint32_t count = 1;
    for (uint32_t width = pyramid[first].width; width / 2 >= kRoughestWidth; width /= 2)
        ++count;
    for (uint32_t i = 1; i < count; ++i)
        mirrored.push_back(filterAll(
            pyramid,
            listSamples(double(i) / (count - 1), std::min(kSamples << (i - 1), kMaxSamples)),
            pyramid[first].width >> i
        ));
    return mirrored;
}

} // namespace shutter::environment
