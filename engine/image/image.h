// SPDX-License-Identifier: MIT
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
    std::vector<std::string> channelNames{}; ///< empty, or one a channel ("R", "motion.x", ...)

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

} // namespace shutter::image
