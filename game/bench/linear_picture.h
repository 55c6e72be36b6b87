// SPDX-License-Identifier: MIT
#pragma once

#include "engine/image/image.h"

namespace shutter::bench {

/// What a reader of the report looks into: the channels R, G and B of a linear picture and, unless
/// it has no pixels, the error map as the channel `flip`.
/// \param color three channels or more
/// \param errorMap one channel, as large as `color`, or without pixels
[[nodiscard]] image::Image
packLinearPicture(const image::Image& color, const image::Image& errorMap = {});

} // namespace shutter::bench
