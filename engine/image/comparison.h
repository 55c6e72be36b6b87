// SPDX-License-Identifier: MIT
// What all metrics share: which pictures can be compared, and which values.
#pragma once

#include "engine/core/check.h"
#include "engine/image/image.h"

#include <cstddef>

namespace shutter::image {

/// CHECKs that both have the same size and channel count, and as many values as these say.
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

} // namespace shutter::image
