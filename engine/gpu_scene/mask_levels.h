// SPDX-License-Identifier: MIT
// Mip levels of textures whose alpha cuts surfaces out.
#pragma once

#include "engine/scene/assets.h"

#include <cstdint>
#include <map>
#include <vector>

namespace shutter::gpu_scene {

/// Images that are the base colour of materials of AlphaMode::Mask, and the alpha of the image that
/// these compare with, in (0, 1]. Images that anything else blends by their alpha, and
/// those whose materials compare with different values, are left out; colours of vertices count as
/// opaque.
[[nodiscard]] std::map<scene::AssetIndex, float> findMasks(const scene::Assets& assets);

/// Texels of all mip levels but the first, sRGB, tightly packed. As much of each reaches the cutoff
/// as of the first level (Castaño 2010, "Computing Alpha Mipmaps"): means alone lose leaves and
/// wires with distance. Colours are means weighted by alpha, so that what is cut out does not
/// tint the border.
/// \param cutoff (0, 1]
[[nodiscard]] std::vector<std::vector<uint8_t>>
makeMaskLevels(const scene::TextureImage& image, float cutoff);

} // namespace shutter::gpu_scene
