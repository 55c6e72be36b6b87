// SPDX-License-Identifier: MIT
#include "engine/environment/directions.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace shutter::environment {

using std::numbers::pi;

math::dvec3 directionAt(math::dvec2 uv) {
    const double azimuth = (uv.x - 0.5) * 2.0 * pi;
    const double polar = uv.y * pi;
    return {
        std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)};
}

math::dvec2 placeOf(math::dvec3 direction) {
    // std::atan2(0, 0) is 0: a pole lies in the middle column.
    const double azimuth = std::atan2(direction.x, direction.z == 0.0 ? 0.0 : -direction.z);
    const double polar = std::acos(std::clamp(direction.y, -1.0, 1.0));
    return {azimuth / (2.0 * pi) + 0.5, polar / pi};
}

double texelSolidAngle(uint32_t row, uint32_t width, uint32_t height) {
    const double top = pi * row / height;
    const double bottom = pi * (row + 1) / height;
    return (std::cos(top) - std::cos(bottom)) * 2.0 * pi / width;
}

namespace {

math::vec3 texelAt(const image::Image& picture, uint32_t x, uint32_t y) {
    const float* texel = &picture.pixels[(size_t(y) * picture.width + x) * picture.channels];
    return {texel[0], texel[1], texel[2]};
}

} // namespace

math::vec3 sampleDirection(const image::Image& picture, math::dvec3 direction) {
    return samplePlace(picture, placeOf(direction));
}

math::vec3 samplePlace(const image::Image& picture, math::dvec2 place) {
    SHUTTER_CHECK(picture.channels >= 3, "{} channels", picture.channels);
    const double x = place.x * picture.width - 0.5;
    const double y = std::clamp(place.y * picture.height - 0.5, 0.0, picture.height - 1.0);
    const auto width = static_cast<int64_t>(picture.width);
    const auto left = static_cast<int64_t>(std::floor(x));
    const auto x0 = static_cast<uint32_t>(((left % width) + width) % width);
    const uint32_t x1 = (x0 + 1) % picture.width;
    const auto y0 = static_cast<uint32_t>(y);
    const uint32_t y1 = std::min(y0 + 1, picture.height - 1);
    const auto across = static_cast<float>(x - std::floor(x));
    const auto down = static_cast<float>(y - y0);
    return glm::mix(
        glm::mix(texelAt(picture, x0, y0), texelAt(picture, x1, y0), across),
        glm::mix(texelAt(picture, x0, y1), texelAt(picture, x1, y1), across),
        down
    );
}

image::Image halve(const image::Image& picture) {
    image::Image half(
        std::max(picture.width / 2, 1u), std::max(picture.height / 2, 1u), picture.channels
    );
    // The last column or row of an odd number counts with the one before it.
    const auto endOf = [](uint32_t at, uint32_t size, uint32_t halfSize) {
        return at + 1 == halfSize ? size : 2 * at + 2;
    };
    for (uint32_t y = 0; y < half.height; ++y) {
        for (uint32_t x = 0; x < half.width; ++x) {
            double total = 0.0;
            std::vector<double> sum(picture.channels, 0.0);
            for (uint32_t row = 2 * y; row < endOf(y, picture.height, half.height); ++row) {
                const double weight = texelSolidAngle(row, picture.width, picture.height);
                for (uint32_t column = 2 * x; column < endOf(x, picture.width, half.width);
                     ++column) {
                    total += weight;
                    for (uint32_t c = 0; c < picture.channels; ++c)
                        sum[c] += weight * picture.at(column, row, c);
                }
            }
            for (uint32_t c = 0; c < picture.channels; ++c)
                half.at(x, y, c) = static_cast<float>(sum[c] / total);
        }
    }
    return half;
}

std::vector<image::Image> makePyramid(image::Image picture, uint32_t least) {
    std::vector<image::Image> pyramid;
    pyramid.push_back(std::move(picture));
    while (pyramid.back().width > std::max(least, 1u))
        pyramid.push_back(halve(pyramid.back()));
    return pyramid;
}

math::vec3
samplePyramid(const std::vector<image::Image>& pyramid, math::dvec3 direction, double level) {
    const double last = static_cast<double>(pyramid.size() - 1);
    const double at = std::clamp(level, 0.0, last);
    const auto below = static_cast<size_t>(at);
    const math::dvec2 place = placeOf(direction);
    const math::vec3 fine = samplePlace(pyramid[below], place);
    if (at == static_cast<double>(below))
        return fine;
    return glm::mix(
        fine,
        samplePlace(pyramid[below + 1], place),
        static_cast<float>(at - static_cast<double>(below))
    );
}

} // namespace shutter::environment
