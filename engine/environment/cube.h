// SPDX-License-Identifier: MIT
#pragma once

#include "engine/image/image.h"

#include <array>
#include <cstdint>

namespace shutter::environment {

/// An equirectangular picture of `width` by `width / 2` from the six sides of a cube, +X -X +Y -Y
/// +Z -Z, each as it is seen from inside the cube with +Y up (-Z at the top of +Y, +Z at the top of
/// -Y): what EXT_lights_image_based stores, OpenGL's cube maps flipped about their vertical axis.
/// \param sides square, of one size and at least three channels (CHECKed)
[[nodiscard]] image::Image unwrapCube(const std::array<image::Image, 6>& sides, uint32_t width);

} // namespace shutter::environment
