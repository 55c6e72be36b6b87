// SPDX-License-Identifier: MIT
// The posts along the rally's road. A car that hits one throws it over, and from then on it moves
// as a thin rigid rod over flat ground.
#pragma once

#include "engine/ecs/registry.h"
#include "engine/math/math.h"
#include "game/demos/rally_car.h"

namespace shutter::game {

/// Along its own Y. Mass counts as 1; its inertia is a thin rod's about any axis.
struct Rod {
    math::dvec3 place{0.0}; ///< of its middle, metres
    math::dquat rotation{1.0, 0.0, 0.0, 0.0};
    math::dvec3 velocity{0.0}; ///< m/s
    math::dvec3 spin{0.0};     ///< rad/s, world axes
    double halfLength = 0.55;  ///< metres
    double radius = 0.07;      ///< metres: how high its axis lies on the ground
    double restSeconds = 0.0;  ///< so long it has hardly moved
    bool asleep = false;       ///< rests for good
};

/// One step of kDemoStepSeconds: gravity, and impulses where an end meets the ground.
void stepRod(Rod& rod);

/// Of its motion and its height over the ground, joules for 1 kg.
[[nodiscard]] double measureEnergy(const Rod& rod);

/// Component: a post, standing until a car hits it.
struct Post {
    Rod rod;
    bool isStanding = true;
};

/// Standing posts that the car has run into are thrown, with what speed they take from the car.
/// \return how many
int hitPosts(ecs::Registry& registry, CarState& car);

/// One step of those that were thrown, into their SimulatedPose.
void stepPosts(ecs::Registry& registry);

} // namespace shutter::game
