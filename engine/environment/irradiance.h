// SPDX-License-Identifier: MIT
#pragma once

#include "engine/image/image.h"
#include "engine/math/math.h"

#include <array>

namespace shutter::environment {

/// Irradiance over pi of every surface, as scene::Environment::irradiance holds it: the picture's
/// first nine spherical harmonics times those of the clamped cosine (Ramamoorthi 2001, eq. 8, 13).
[[nodiscard]] std::array<math::vec3, 9> projectIrradiance(const image::Image& picture);

/// What the coefficients say of a surface; never negative. \param normal unit
[[nodiscard]] math::vec3
evaluateIrradiance(const std::array<math::vec3, 9>& coefficients, math::vec3 normal);

} // namespace shutter::environment
