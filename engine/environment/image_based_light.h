// SPDX-License-Identifier: MIT
// Light from an equirectangular picture: irradiance for diffuse surfaces and prefiltered
// reflections for glossy ones.
#pragma once

#include "engine/image/image.h"
#include "engine/math/math.h"

#include <array>
#include <cstdint>
#include <vector>

namespace shutter::environment {

/// Irradiance over pi of every surface, as scene::Environment::irradiance holds it: the picture's
/// first nine spherical harmonics times those of the clamped cosine (Ramamoorthi 2001, eq. 8, 13).
[[nodiscard]] std::array<math::vec3, 9> projectIrradiance(const image::Image& picture);

/// Irradiance of a surface from the coefficients; never negative. \param normal unit
[[nodiscard]] math::vec3
evaluateIrradiance(const std::array<math::vec3, 9>& coefficients, math::vec3 normal);

/// Width of the picture that is mirrored sharply, where the environment's own is wider.
inline constexpr uint32_t kMirrorWidth = 1024;
/// Width of the one for a roughness of 1: few enough texels round a pole that none shows there.
inline constexpr uint32_t kRoughestWidth = 32;

/// Prefiltered reflections by rising roughness (scene::Environment::mirrored): each texel the mean
/// over directions that follow the GGX distribution round it, weighted by their cosine (Karis
/// 2013), each sampled from the level that matches its solid angle (Krivanek and Colbert 2008).
/// \param picture twice as wide as high, at least two texels wide, three channels
[[nodiscard]] std::vector<image::Image> prefilterMirrored(const image::Image& picture);

} // namespace shutter::environment
