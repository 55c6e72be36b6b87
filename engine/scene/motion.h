// SPDX-License-Identifier: MIT
// Placements of entities at any time: the single source for motion vectors, rays and ground truth.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"
#include "engine/scene/shutter.h"
#include "engine/scene/world.h"

namespace shutter::scene {

/// World transform of `entity` at `seconds`, from paths, clips, velocity components and its
/// parents. A path or else a clip gives the pose, velocities are added to it. Times may come in any
/// order; nothing is integrated in steps, so the result is exact. `entity` and its parents must be
/// alive, `seconds` finite. An entity without a transform sits at its parent.
[[nodiscard]] math::dmat4 worldFromEntity(const World& world, ecs::Entity entity, double seconds);

/// The same for a camera, with forward -Z and up +Y (glTF 2.0, 3.10.2, "with the scaling ignored").
/// Its own scale has no effect, even if negative or 0; parents rotate it as in math::findRigid,
/// without their scale if that would leave it no direction.
[[nodiscard]] math::dmat4 worldFromRigid(const World& world, ecs::Entity entity, double seconds);

/// The same for a light, which shines along -Z: worldFromEntity, with the z axis of worldFromRigid
/// if scale leaves its own no length.
[[nodiscard]] math::dmat4 worldFromLight(const World& world, ecs::Entity entity, double seconds);

/// False if neither `entity` nor one of its parents has a component that could move it:
/// worldFromEntity is then constant.
[[nodiscard]] bool mayMove(const World& world, ecs::Entity entity);

} // namespace shutter::scene
