// SPDX-License-Identifier: MIT
#include "engine/environment/cube.h"

#include "engine/core/check.h"
#include "engine/environment/directions.h"

#include <algorithm>
#include <cmath>

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
