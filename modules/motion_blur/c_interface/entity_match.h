// SPDX-License-Identifier: MIT
// Which entity of a frame is which of the frame before, for hosts that have no names for them.
#pragma once

#include "modules/motion_blur/c_interface/shutter_motion_blur.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::motion_blur {

/// shutterBlurMatchEntities(): for each of `now` an index of `before`, UINT32_MAX for none.
[[nodiscard]] std::vector<uint32_t> matchEntities(
    std::span<const ShutterBlurEntity> before, std::span<const ShutterBlurEntity> now, double reach
);

} // namespace shutter::motion_blur
