// SPDX-License-Identifier: MIT
// Private to engine/io.
#pragma once

#include "engine/io/gltf_context.h"
#include "engine/scene/assets.h"

#include <vector>

namespace shutter::io {

/// Fills Assets::meshes (same indices as in the file). Materials have to be loaded before: a normal
/// map decides whether tangents are needed. Throws GltfError.
void loadMeshes(GltfContext& context, scene::Assets& assets);

/// Checks the joints of every mesh that a node draws with a skin against that skin. Throws
/// GltfError.
void checkSkinnedNodes(GltfContext& context);

} // namespace shutter::io
