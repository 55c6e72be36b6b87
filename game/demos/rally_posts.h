// SPDX-License-Identifier: MIT
// The posts along the road, which a car throws over.
#pragma once

#include "engine/ecs/registry.h"
#include "game/demos/rally_car.h"
#include "game/demos/rod.h"

namespace shutter::game {

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
