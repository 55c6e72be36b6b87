// SPDX-License-Identifier: MIT
#include "engine/environment/directions.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace shutter::environment {

namespace {

struct CubePlace {
    size_t side = 0;
    math::dvec2 uv{0.0}; ///< of the stored picture
};

/// Vulkan 1.3, 16.5.4 (table "Cube map face selection"), u mirrored.
CubePlace findPlace(math::dvec3 d) {
    const math::dvec3 size = glm::abs(d);
    size_t side = 0;
    double s = 0.0;
    double t = 0.0;
    double major = 1.0;
    if (size.z >= size.x && size.z >= size.y) {
        side = d.z >= 0.0 ? 4 : 5;
        s = d.z >= 0.0 ? d.x : -d.x;
        t = -d.y;
        major = size.z;
    } else if (size.y >= size.x) {
        side = d.y >= 0.0 ? 2 : 3;
        s = d.x;
        t = d.y >= 0.0 ? d.z : -d.z;
        major = size.y;
    } else {
        side = d.x >= 0.0 ? 0 : 1;
        s = d.x >= 0.0 ? -d.z : d.z;
        t = -d.y;
        major = size.x;
    }
    return {side, {1.0 - (s / major + 1.0) / 2.0, (t / major + 1.0) / 2.0}};
}

/// Between the four nearest texels of one side.
float sample(const image::Image& side, math::dvec2 uv, uint32_t channel) {
    const double last = side.width - 1.0;
    const double x = std::clamp(uv.x * side.width - 0.5, 0.0, last);
    const double y = std::clamp(uv.y * side.height - 0.5, 0.0, last);
    const auto x0 = static_cast<uint32_t>(x);
    const auto y0 = static_cast<uint32_t>(y);
    const uint32_t x1 = std::min(x0 + 1, side.width - 1);
    const uint32_t y1 = std::min(y0 + 1, side.height - 1);
    const auto across = static_cast<float>(x - x0);
    const auto down = static_cast<float>(y - y0);
    return std::lerp(
        std::lerp(side.at(x0, y0, channel), side.at(x1, y0, channel), across),
        std::lerp(side.at(x0, y1, channel), side.at(x1, y1, channel), across),
        down
    );
}

} // namespace

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

image::Image unwrapCube(const std::array<image::Image, 6>& sides, uint32_t width) {
    for (const image::Image& side : sides) {
        SHUTTER_CHECK(
            side.width > 0 && side.width == side.height && side.channels >= 3 &&
                side.width == sides[0].width,
            "a side of {}x{}",
            side.width,
            side.height
        );
    }
    image::Image picture(width, width / 2, 3);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const CubePlace place =
                findPlace(directionAt({(x + 0.5) / width, (y + 0.5) / picture.height}));
            for (uint32_t c = 0; c < 3; ++c)
                picture.at(x, y, c) = sample(sides[place.side], place.uv, c);
        }
    return picture;
}

} // namespace shutter::environment
