// SPDX-License-Identifier: MIT
#pragma once

#include "engine/image/image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace shutter::bench {

/// A detail to magnify, in pixels of the picture.
struct Crop {
    uint32_t x = 0;
    uint32_t y = 0;
    uint32_t width = 0;
    uint32_t height = 0;
    std::string label;
};

/// The square in which two pictures differ most (sum of absolute differences), on a grid of a
/// quarter of its side, not meeting any square of `taken`. Empty where the pictures are equal or
/// smaller than the square.
[[nodiscard]] std::vector<Crop> findLargestDifference(
    const image::Image& a,
    const image::Image& b,
    uint32_t sidePx,
    const std::string& label,
    const std::vector<Crop>& taken
);

} // namespace shutter::bench
