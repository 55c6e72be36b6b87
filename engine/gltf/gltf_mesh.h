// SPDX-License-Identifier: MIT
// Private to engine/gltf.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/scene/assets.h"

namespace shutter::gltf {

/// Fills Assets::meshes (same indices as in the file). Materials have to be loaded before: a normal
/// map decides whether tangents are needed. Throws GltfError.
void loadMeshes(GltfContext& context, scene::Assets& assets);

} // namespace shutter::gltf
