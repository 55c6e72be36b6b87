// SPDX-License-Identifier: MIT
// The transfer functions of sRGB (IEC 61966-2-1), of values in [0, 1].
#pragma once

#include <cmath>

namespace shutter::math {

[[nodiscard]] inline float decodeSrgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

[[nodiscard]] inline float encodeSrgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

} // namespace shutter::math
