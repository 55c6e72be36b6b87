// SPDX-License-Identifier: MIT
// Private to engine/gltf: EXT_mesh_gpu_instancing.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/scene/world.h"

#include <vector>

namespace shutter::gltf {

/// Gives each instance of a node an entity of its own below the node's, which draws what the node
/// drew, at its own transform and with the same morph weights; the node itself draws nothing then.
/// Call it last: nodes have to have all their components. Throws GltfError.
/// \param entities as loadNodes returns them
void expandInstances(
    GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities
);

} // namespace shutter::gltf
