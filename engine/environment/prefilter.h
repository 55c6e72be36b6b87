// SPDX-License-Identifier: MIT
#pragma once

#include "engine/image/image.h"

#include <cstdint>
#include <vector>

namespace shutter::environment {

/// Width of the picture that is mirrored sharply, where the environment's own is wider.
inline constexpr uint32_t kMirrorWidth = 1024;
/// Width of the one for a roughness of 1: few enough texels round a pole that none shows there.
inline constexpr uint32_t kRoughestWidth = 32;

/// What surfaces mirror, by rising roughness (scene::Environment::mirrored): each texel the mean
/// over directions that follow the GGX distribution round it, weighted by their cosine (Karis
/// 2013), each looked up in a level as coarse as its share of the solid angle (Krivanek and Colbert
/// 2008). \param picture twice as wide as high, at least two texels wide, three channels
[[nodiscard]] std::vector<image::Image> prefilterMirrored(const image::Image& picture);

} // namespace shutter::environment
