// SPDX-License-Identifier: MIT
// The effect without a device: what a metric compares is what a display shows.
#pragma once

#include "engine/image/image.h"
#include "modules/tonemap/tonemap.h"

namespace shutter::tonemap {

/// `linear` as a display takes it, by the very functions of the shader (gain, operator, sRGB), not
/// rounded to eight bits. One channel (grey) or three: CHECKed. Light below 0 counts as 0, infinite
/// light as white. A pixel with a NaN is NaN in every channel, so that a metric can count it.
[[nodiscard]] image::Image
computeDisplayImage(const image::Image& linear, const TonemapSettings& settings);

} // namespace shutter::tonemap
