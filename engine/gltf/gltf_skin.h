// SPDX-License-Identifier: MIT
// Private to engine/gltf: skins, and the joints and weights of the vertices they bend.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/scene/assets.h"
#include "engine/scene/world.h"

#include <string>
#include <vector>

namespace shutter::gltf {

/// Fills the influences of `primitive` from JOINTS_0, WEIGHTS_0 and JOINTS_1, WEIGHTS_1 of
/// `source`: of each vertex the weights sum to 1. Weights below 0 and such that are not finite
/// become 0, and a vertex that is left with none follows the first joint it names; both with a
/// warning. Throws GltfError, naming `path`.
void readInfluences(
    GltfContext& context,
    const tinygltf::Primitive& source,
    const std::string& path,
    scene::Primitive& primitive
);

/// Fills Assets::skins (same indices as in the file). Throws GltfError.
void loadSkins(GltfContext& context, scene::Assets& assets);

/// Checks the joints of every mesh that a node draws with a skin against that skin. Primitives of
/// such meshes without influences are bound to the first joint, with a warning. Needs meshes and
/// skins. Throws GltfError.
void bindMeshes(GltfContext& context, scene::Assets& assets);

/// Gives entities that draw a mesh with a skin their scene::Skinned.
/// \param entities as loadNodes returns them; those of the joints of drawn skins are not null
void addSkins(GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities);

} // namespace shutter::gltf
