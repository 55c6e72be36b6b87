// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/check.h"
#include "engine/ecs/registry.h"
#include "engine/scene/assets.h"
#include "engine/scene/components.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace shutter::scene {

/// How animation clips play.
struct Playback {
    bool loop = false;             ///< false: clips hold at their ends
    std::vector<bool> activeClips; ///< by clip; false: does not play; clips beyond its end do
};

/// The entities and the assets that they refer to. Systems, extraction and the renderer take it by
/// reference; passes only see extracted data.
struct World {
    ecs::Registry registry;
    Assets assets;
    Playback playback;
    std::vector<ecs::Entity> cameras; ///< in the order of the file
    /// Time at which the world begins: nothing has a past before it. Default: it always existed.
    double startSeconds = -std::numeric_limits<double>::infinity();
};

/// The first of `entity`, its parent, its parent's parent and so on for which `matches` is true, or
/// null.
template <class Matches>
[[nodiscard]] ecs::Entity findUpwards(const World& world, ecs::Entity entity, Matches&& matches) {
    const ecs::Registry& registry = world.registry;
    size_t steps = 0;
    for (ecs::Entity ancestor = entity; ancestor != ecs::kNullEntity; ++steps) {
        SHUTTER_CHECK(steps < registry.aliveCount(), "the parents of {} form a cycle", entity);
        if (matches(ancestor))
            return ancestor;
        const auto* parent = registry.find<Parent>(ancestor);
        ancestor = parent ? parent->entity : ecs::kNullEntity;
    }
    return ecs::kNullEntity;
}

} // namespace shutter::scene
