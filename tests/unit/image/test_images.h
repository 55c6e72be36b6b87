// SPDX-License-Identifier: MIT
#pragma once

#include "engine/image/image.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>

namespace shutter::image {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

inline Image makeConstant(uint32_t width, uint32_t height, uint32_t channels, float value) {
    Image image(width, height, channels);
    std::fill(image.pixels.begin(), image.pixels.end(), value);
    return image;
}

/// Steps of 1/255 without a pattern, so that the same picture can be written in eight bits.
inline Image makeNoise(uint32_t width, uint32_t height, uint32_t channels, uint32_t seed) {
    Image image(width, height, channels);
    std::mt19937 random(seed);
    for (float& value : image.pixels)
        value = float(random() % 256u) / 255.0f;
    return image;
}

} // namespace shutter::image
