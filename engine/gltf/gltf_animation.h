// SPDX-License-Identifier: MIT
// Private to engine/gltf.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/scene/world.h"

#include <vector>

namespace shutter::gltf {

/// Fills Assets::clips with the translation, rotation, scale and weights channels, puts Animated on
/// the entities they drive, adds to their MorphWeights, and makes every clip active. `entities` is
/// what loadNodes returned; the meshes tell how many weights a node has. Throws GltfError.
void loadAnimations(
    GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities
);

} // namespace shutter::gltf
