// SPDX-License-Identifier: MIT
// Skinned and morphed meshes: their shape at any time, and where the space of their vertices is.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/assets.h"
#include "engine/scene/vertex_waves.h"
#include "engine/scene/world.h"

#include <cstddef>
#include <vector>

namespace shutter::scene {

/// The shape of a mesh at one instant. A vertex is first morphed, then displaced by waves, then
/// skinned (glTF 2.0, 3.7.2.2): p' = sum over its joints of weight * objectFromBind[joint] *
/// wave(p + sum over targets of weight * d).
struct Deformation {
    std::vector<math::dmat4> objectFromBind; ///< one per joint; empty: not skinned
    std::vector<double> morphWeights;        ///< one per target; empty: not morphed
    WavePose waves;

    /// Vertices are where the mesh has them.
    [[nodiscard]] bool isRest() const {
        return objectFromBind.empty() && morphWeights.empty() && waves.waves.empty();
    }
};

/// True when the entity's mesh is skinned or morphed, or waves.
[[nodiscard]] bool isDeformable(const World& world, ecs::Entity entity);

/// False when the shape (not the place, see mayMove) is the same at every time.
[[nodiscard]] bool mayDeform(const World& world, ecs::Entity entity);

/// Placement of the space of deformed vertices: worldFromEntity, or, for a skinned entity, the
/// world's axes at its first joint, so that numbers stay small for any place of the skeleton.
[[nodiscard]] math::dmat4 worldFromObject(const World& world, ecs::Entity entity, double seconds);

/// False when worldFromObject answers the same at every time.
[[nodiscard]] bool mayObjectMove(const World& world, ecs::Entity entity);

/// \param seconds finite, any time, in any order
[[nodiscard]] Deformation deformationAt(const World& world, ecs::Entity entity, double seconds);

/// Deformation::objectFromBind of one joint of a skinned entity.
[[nodiscard]] math::dmat4
objectFromBind(const World& world, ecs::Entity entity, size_t joint, double seconds);

/// The channel's weights at `seconds`, clamped to its keys; targetCount values.
[[nodiscard]] std::vector<double> sampleWeights(const WeightChannel& channel, double seconds);

} // namespace shutter::scene
