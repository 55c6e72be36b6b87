// SPDX-License-Identifier: MIT
// The posts along the rally's road. A car that hits one throws it over, and from then on it moves
// as a thin rigid rod over flat ground.
#pragma once

#include "engine/ecs/registry.h"
#include "engine/math/math.h"
#include "game/demos/rally_car.h"

namespace shutter::game {

/// A rod along its own Y with a mass of 1, and a thin rod's inertia about every axis.
struct Rod {
    math::dvec3 place{0.0}; ///< its middle, metres
    math::dquat rotation{1.0, 0.0, 0.0, 0.0};
    math::dvec3 velocity{0.0}; ///< m/s
    math::dvec3 spin{0.0};     ///< rad/s, world axes
    double halfLength = 0.55;  ///< metres
    double radius = 0.07;      ///< metres: height of its axis when it lies on the ground
    double restSeconds = 0.0;  ///< how long it has hardly moved
    bool asleep = false;       ///< comes to rest and stays there
};

/// Advances by kDemoStepSeconds: gravity, and impulses where an end meets the ground.
void stepRod(Rod& rod);

/// Kinetic and potential energy, joules for a mass of 1 kg.
[[nodiscard]] double measureEnergy(const Rod& rod);

/// Component: a post, upright until a car hits it.
struct Post {
    Rod rod;
    bool isStanding = true;
};

/// Throws over the standing posts that the car has run into, which takes speed from the car.
/// Those with an emitter spark.
/// \return the number of posts
int hitPosts(ecs::Registry& registry, CarState& car, double seconds);

/// Advances the thrown posts by one step and writes their SimulatedPose.
void stepPosts(ecs::Registry& registry);

} // namespace shutter::game
