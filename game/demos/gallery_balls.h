// SPDX-License-Identifier: MIT
// Balls that are thrown, bounce off floor and walls, and are picked up again.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/world.h"

namespace shutter::game {

inline constexpr double kBallRadius = 0.10; ///< metres
inline constexpr double kBallSeconds = 5.0; ///< until it is picked up

/// Component: a ball; on the pile while it does not fly.
struct Ball {
    math::dvec3 velocity{0.0}; ///< m/s
    math::dvec3 spin{0.0};     ///< rad/s
    double seconds = 0.0;      ///< since it was thrown
    bool flies = false;
    bool hasHit = false; ///< a target: each ball counts once
    ecs::Entity flash{}; ///< emits where it hits; null: nothing does
};

/// The room in which balls bounce.
struct BallRoom {
    math::dvec3 low{-7.1, 0.0, -12.0};
    math::dvec3 high{7.1, 30.0, 2.5};
};

/// Throws one that lies on the pile, or else the one that has flown longest.
void throwBall(
    scene::World& world, const math::dvec3& from, const math::dvec3& velocity, double seconds
);

/// One step of all that fly, into their SimulatedPose; those that flew kBallSeconds are hidden.
void stepBalls(scene::World& world, const BallRoom& room);

/// Kinetic and potential energy of a ball, joules for a mass of 1 kg.
[[nodiscard]] double measureEnergy(const Ball& ball, double height);

} // namespace shutter::game
