// SPDX-License-Identifier: MIT
// Motion of entities that are simulated in fixed steps: the past is known, the future is not. The
// poses of the last steps become keys of a PathMotion, so that an exposure which ends at the
// simulated time (ShutterPhase::End) is as exact as for a clip (exposure_motion.h).
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/transform.h"
#include "engine/scene/world.h"

namespace shutter::scene {

/// How far back recorded motion reaches; at earlier times an entity has its oldest pose. Longer
/// than any exposure of a film camera.
inline constexpr double kRecordedSeconds = 0.5;

/// Component: the motion of this entity, and of those that carry it, is recorded so much longer.
struct NeedsPast {
    double seconds = 0.0; ///< 0 or more
};

/// Component: when a pose was recorded last. Goes with a PathMotion of linear keys.
struct RecordedMotion {
    double seconds = 0.0;
};

/// Records that the entity is at `pose` in its parent's space at `seconds`. It moves there on a
/// straight line from the pose recorded before, and rotates at a constant rate along the shorter
/// arc, less than half a turn per step. The first pose holds for all earlier times. An entity at
/// rest costs one key and is not marked as changed (ecs::Registry::changesSince). Costs amortised
/// constant time; poses that kRecordedSeconds never reaches are dropped.
/// \param pose finite; its scale is ignored in favour of LocalTransform's
/// \param seconds finite, after the pose recorded before
void recordMotion(World& world, ecs::Entity entity, const math::Transform& pose, double seconds);

/// As recordMotion, but as a jump: the entity stays at the pose recorded before until `seconds` and
/// has no past (history.h). For a camera, or an entity that carries it, this is a cut.
void recordJump(World& world, ecs::Entity entity, const math::Transform& pose, double seconds);

} // namespace shutter::scene
