// SPDX-License-Identifier: MIT
// Measurements of pictures for laws.
#pragma once

#include "engine/image/image.h"
#include "engine/math/math.h"

#include <functional>

namespace shutter::test {

[[nodiscard]] bool allFinite(const image::Image& picture);

/// Same size and the same bits.
[[nodiscard]] bool sameBits(const image::Image& a, const image::Image& b);

/// Left and right exchanged.
[[nodiscard]] image::Image mirror(const image::Image& picture);

/// Centre of the brightness (sum of RGB) in pixels from the top left corner; pixel (0, 0) has its
/// centre at (0.5, 0.5). NaN for a black picture.
[[nodiscard]] math::dvec2 computeCentroid(const image::Image& picture);

/// Largest difference of the first three channels over the pixels `where` picks; NaN counts as
/// infinity.
[[nodiscard]] double computeMaxDifferenceWhere(
    const image::Image& a,
    const image::Image& b,
    const std::function<bool(uint32_t x, uint32_t y)>& where
);

/// Pixels whose first channel is above one half.
[[nodiscard]] size_t countSet(const image::Image& mask);

} // namespace shutter::test
