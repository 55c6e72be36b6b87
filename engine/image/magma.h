// SPDX-License-Identifier: MIT
#pragma once

#include "engine/image/image.h"

namespace shutter::image {

/// Colours for display (sRGB) of a map's first channel: 0 black, through violet and orange, 1 pale
/// yellow; clamped to [0, 1], NaN as 1. The colour map magma (S. van der Walt, N. Smith, 2015),
/// within 3/255 of the original.
[[nodiscard]] Image colorWithMagma(const Image& map);

} // namespace shutter::image
