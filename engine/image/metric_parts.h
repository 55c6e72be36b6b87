// SPDX-License-Identifier: MIT
// Private to engine/image: code shared by the metrics, and the separable filters of FLIP.
#pragma once

#include "engine/core/check.h"
#include "engine/image/image.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shutter::image {

/// CHECKs that both have the same size, channel count and, as these imply, number of values.
inline void checkComparable(const Image& a, const Image& b) {
    SHUTTER_CHECK_EQ(a.width, b.width);
    SHUTTER_CHECK_EQ(a.height, b.height);
    SHUTTER_CHECK_EQ(a.channels, b.channels);
    SHUTTER_CHECK_EQ(a.pixels.size(), size_t(a.width) * a.height * a.channels);
    SHUTTER_CHECK_EQ(b.pixels.size(), a.pixels.size());
}

/// Clamped to [0, 1]; NaN passes through (each comparison with it is false).
template <typename Real> [[nodiscard]] constexpr Real clampToUnit(Real value) {
    return value < Real(0) ? Real(0) : (value > Real(1) ? Real(1) : value);
}

/// One value per pixel, row 0 at the top.
struct Plane {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<float> values; ///< width * height

    Plane() = default;

    Plane(uint32_t w, uint32_t h) : width(w), height(h), values(size_t(w) * h, 0.0f) {}
};

/// Weights at the offsets -radius ... radius; their number is odd.
using Kernel = std::vector<float>;

/// result(x) = sum over offsets o of kernel(o) * plane(x + o). Outside of the picture its border
/// pixels are repeated. A NaN spreads to every pixel whose kernel covers it.
[[nodiscard]] Plane filterAlongX(const Plane& plane, const Kernel& kernel);
[[nodiscard]] Plane filterAlongY(const Plane& plane, const Kernel& kernel);

} // namespace shutter::image
