// SPDX-License-Identifier: MIT
// Private to engine/gltf: the node hierarchy as entities.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/math/transform.h"
#include "engine/scene/world.h"

#include <optional>
#include <vector>

namespace shutter::gltf {

/// Translation, rotation and scale whose product is `matrix` (to 1e-5 of its size), or nothing
/// where it shears or flattens an axis. A mirror becomes a negative x scale. Needs finite elements
/// and 0 0 0 1 in the last row.
[[nodiscard]] std::optional<math::Transform> decomposeMatrix(const math::dmat4& matrix);

/// Makes an entity, in the order of the file, of every node of the default scene and fills
/// World::cameras. Joints that lie outside of the scene, and what is above them, become entities
/// that draw nothing. Returns the entity of every node of the file: the null entity for the others.
/// Needs the meshes, whose morph weights are those of nodes that give none. Throws GltfError for
/// graphs that are no forest and values nothing can be drawn with.
[[nodiscard]] std::vector<ecs::Entity> loadNodes(GltfContext& context, scene::World& world);

} // namespace shutter::gltf
