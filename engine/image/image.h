// SPDX-License-Identifier: MIT
// Pictures in main memory, as half floats and as colour maps.
#pragma once

#include "engine/core/check.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace shutter::image {

/// Pixels in main memory: interleaved 32-bit floats, row 0 at the top.
struct Image {
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t channels = 0;
    std::vector<float> pixels;               ///< width * height * channels
    std::vector<std::string> channelNames{}; ///< empty, or one per channel ("R", "motion.x")

    Image() = default;

    Image(uint32_t w, uint32_t h, uint32_t c)
        : width(w), height(h), channels(c), pixels(size_t(w) * h * c, 0.0f) {}

    [[nodiscard]] float& at(uint32_t x, uint32_t y, uint32_t c) {
        return pixels[(size_t(y) * width + x) * channels + c];
    }

    [[nodiscard]] float at(uint32_t x, uint32_t y, uint32_t c) const {
        return pixels[(size_t(y) * width + x) * channels + c];
    }
};

/// The half float nearest to `value`, as a float; infinite where |value| is 65520 or more.
[[nodiscard]] float roundToHalf(float value);

/// Every value of the picture as the bits of its nearest half float, in the picture's order, as an
/// RGBA16F image stores them.
[[nodiscard]] std::vector<uint16_t> packHalf(const Image& picture);

/// Colours for display (sRGB) of a map's first channel: 0 black, through violet and orange, 1 pale
/// yellow; clamped to [0, 1], NaN as 1. The colour map magma (S. van der Walt, N. Smith, 2015),
/// within 3/255 of the original.
[[nodiscard]] Image colorWithMagma(const Image& map);

} // namespace shutter::image
