// SPDX-License-Identifier: MIT
// Private to engine/gltf.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/scene/assets.h"

namespace shutter::gltf {

/// Fills Assets::materials (same indices as in the file), textures and images. Factors outside the
/// range that glTF gives them are clamped with a warning. Throws GltfError.
void loadMaterials(GltfContext& context, scene::Assets& assets);

} // namespace shutter::gltf
