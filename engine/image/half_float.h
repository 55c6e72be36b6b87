// SPDX-License-Identifier: MIT
// Pictures as an image of half floats (RGBA16F) stores them.
#pragma once

#include "engine/image/image.h"

#include <cstdint>
#include <vector>

namespace shutter::image {

/// The half float nearest to `value`, as a float; infinite where |value| is 65520 or more.
[[nodiscard]] float roundToHalf(float value);

/// The bits of every value's nearest half float, in the picture's order.
[[nodiscard]] std::vector<uint16_t> packHalf(const Image& picture);

} // namespace shutter::image
