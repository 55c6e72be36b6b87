// SPDX-License-Identifier: MIT
// Motion of what is simulated in fixed steps: where it was is known, where it will be is not. The
// poses of the last steps are kept as the keys of a PathMotion, so that an exposure which ends at
// the simulated time (ShutterPhase::End) is answered as exactly as for a clip (exposure_motion.h).
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/transform.h"
#include "engine/scene/world.h"

namespace shutter::scene {

/// How far back recorded motion reaches; earlier in an exposure a thing stands where the oldest
/// pose has it. Longer than any exposure of a film camera. What emits particles, or carries what
/// does, keeps the longest life of one more.
inline constexpr double kRecordedSeconds = 0.5;

/// Component: when a pose was recorded last. Goes with a PathMotion of linear keys.
struct RecordedMotion {
    double seconds = 0.0;
};

/// The entity stands at `pose` of its parent's space at `seconds` and came there on a straight way
/// from the pose recorded before, turning at a constant rate the shorter way: less than half a turn
/// a step. The first pose holds for all times before. What rests costs one key and is not noted as
/// changed (ecs::Registry::changesSince). Costs amortised constant time; poses that
/// kRecordedSeconds never reaches are dropped.
/// \param pose finite; its scale is not looked at, that of LocalTransform stays
/// \param seconds finite, after the pose recorded before
void recordMotion(World& world, ecs::Entity entity, const math::Transform& pose, double seconds);

/// As recordMotion, but it was put there: it stays at the pose recorded before until `seconds` and
/// has no past (history.h). A camera, or what carries it, cuts.
void recordJump(World& world, ecs::Entity entity, const math::Transform& pose, double seconds);

} // namespace shutter::scene
