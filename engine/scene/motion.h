// SPDX-License-Identifier: MIT
// The one question that motion vectors, rays and ground truth all ask.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"
#include "engine/scene/shutter.h"
#include "engine/scene/world.h"

namespace shutter::scene {

/// World transform of `entity` at `seconds`, whatever moves it: paths, clips, velocity components,
/// its parents, or several of them. A path or else a clip gives the pose, velocities are added to
/// it. Any time may be asked for, in any order; nothing is integrated step by step, so the answer
/// is exact. `entity` and its parents must be alive, `seconds` finite. An entity without a
/// transform sits at its parent.
[[nodiscard]] math::dmat4 worldFromEntity(const World& world, ecs::Entity entity, double seconds);

/// The same of what looks along its -Z with +Y up: the view of a camera (glTF 2.0, 3.10.2, "with
/// the scaling ignored"). Its own scale has no effect, negative or 0 though it be; parents turn it
/// as math::findRigid says, and do so without their scale where that leaves it no direction.
[[nodiscard]] math::dmat4 worldFromRigid(const World& world, ecs::Entity entity, double seconds);

/// The same of what shines along its -Z: worldFromEntity, whose z axis is that of worldFromRigid
/// where scale leaves it no length.
[[nodiscard]] math::dmat4 worldFromLight(const World& world, ecs::Entity entity, double seconds);

/// False when nothing that could move `entity` is on it or on one of its parents: worldFromEntity
/// then answers the same at every time.
[[nodiscard]] bool mayMove(const World& world, ecs::Entity entity);

} // namespace shutter::scene
