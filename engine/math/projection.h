// SPDX-License-Identifier: MIT
#pragma once

#include "engine/math/math.h"

namespace shutter::math {

/// Perspective with reversed depth and the far plane at infinity: clip depth is near / distance,
/// so a float depth buffer keeps its relative precision at every distance. Clip w is the distance
/// along the view direction. y points down (Vulkan).
/// \param yFov vertical field of view in radians, in (0, pi)
/// \param aspect width / height, above 0
/// \param near distance of the near plane in metres, above 0
[[nodiscard]] dmat4 clipFromViewPerspective(double yFov, double aspect, double near);

/// Orthographic with reversed depth: 1 at `near`, 0 at `far`; clip w is 1.
/// \param xMag, yMag half width and half height of the view in metres, above 0
[[nodiscard]] dmat4 clipFromViewOrthographic(double xMag, double yMag, double near, double far);

} // namespace shutter::math
