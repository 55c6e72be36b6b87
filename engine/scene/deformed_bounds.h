// SPDX-License-Identifier: MIT
// Boxes around skinned and morphed meshes, computed without their vertices.
#pragma once

#include "engine/math/bounds.h"
#include "engine/scene/assets.h"
#include "engine/scene/deformation.h"

#include <span>
#include <vector>

namespace shutter::scene {

/// Data of the vertices for the bounds of a pose. Computed once for a mesh or a part of one; small.
struct PoseReach {
    math::Bounds rest;                 ///< of all vertices; as Mesh::bounds
    std::vector<math::Bounds> joints;  ///< of the vertices each joint deforms; empty: deforms none
    std::vector<math::Bounds> targets; ///< of each morph target's displacement at weight 1
};

/// Vertices of a primitive without influences count as deformed by joint 0. A joint of weight 0
/// deforms nothing.
[[nodiscard]] PoseReach computePoseReach(std::span<const Primitive> primitives);

/// Holds every vertex of the pose in the space of worldFromObject, for any weights of morph targets
/// (also outside of [0, 1]). Not the smallest such box: each joint moves the box of its vertices,
/// which morph targets have grown. Costs one box per joint and one per target. 1e-6 of the
/// coordinates is added, because skin weights sum to 1 in single precision only; without a
/// deformation the result is `rest` itself. Empty for a mesh without vertices and for weights that
/// are not finite; a joint whose matrix is not finite is ignored, since vertices that it deforms
/// are not drawn.
[[nodiscard]] math::Bounds
computeDeformedBounds(const PoseReach& reach, const Deformation& deformation);

} // namespace shutter::scene
