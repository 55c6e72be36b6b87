// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace shutter::game {

/// Width and height of a picture, pixels.
struct PictureSize {
    uint32_t width = 0;
    uint32_t height = 0;
};

} // namespace shutter::game
