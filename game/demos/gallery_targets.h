// SPDX-License-Identifier: MIT
// Targets that cross on rails, fall over when hit, and come again.
#pragma once

#include "engine/ecs/registry.h"
#include "engine/math/math.h"
#include "game/demos/random.h"

#include <optional>

namespace shutter::game {

/// Component: a target on a rail along X.
struct Target {
    math::dvec3 rail{0.0};     ///< the rail's middle, metres
    double halfLength = 1.0;   ///< of the rail, metres
    double radius = 0.3;       ///< of the face, metres
    double faceHeight = 0.5;   ///< of the face's middle over the rail, metres
    double slowest = 1.0;      ///< m/s, of the rail's targets
    double fastest = 2.0;      ///< m/s
    double along = 0.0;        ///< from the rail's middle, metres
    double speed = 0.0;        ///< m/s along X, of either sign
    double fall = 0.0;         ///< radians, 0 upright
    double downSeconds = -1.0; ///< since it was hit; negative: it is upright
};

/// One step, into each SimulatedPose. A target that leaves its rail comes in again at the other
/// end, at another speed; one that was hit does so after a while.
void stepTargets(ecs::Registry& registry, Random& random);

/// A ball that reaches the face of a standing target.
struct TargetHit {
    ecs::Entity target;
    double speed = 0.0; ///< of the target, m/s
};

/// Knocks over the first target that the ball meets.
[[nodiscard]] std::optional<TargetHit>
hitTarget(ecs::Registry& registry, const math::dvec3& ball, double ballRadius);

/// Points of a hit: ten for each m/s.
[[nodiscard]] int pointsFor(const TargetHit& hit);

} // namespace shutter::game
