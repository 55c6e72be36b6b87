// SPDX-License-Identifier: MIT
// Separable filters over single-channel pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shutter::image {

/// One value a pixel, row 0 at the top.
struct Plane {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<float> values; ///< width * height

    Plane() = default;

    Plane(uint32_t w, uint32_t h) : width(w), height(h), values(size_t(w) * h, 0.0f) {}
};

/// Weights of the offsets -radius ... radius; an odd number of them.
using Kernel = std::vector<float>;

/// result(x) = sum over offsets o of kernel(o) * plane(x + o). Pixels past the picture's ends are
/// those at its ends. A NaN reaches every pixel whose kernel holds it.
[[nodiscard]] Plane filterAlongX(const Plane& plane, const Kernel& kernel);
[[nodiscard]] Plane filterAlongY(const Plane& plane, const Kernel& kernel);

} // namespace shutter::image
