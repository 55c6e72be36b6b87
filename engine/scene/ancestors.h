// SPDX-License-Identifier: MIT
// Private to engine/scene: the way from an entity up to its root.
#pragma once

#include "engine/core/check.h"
#include "engine/scene/world.h"

#include <cstddef>

namespace shutter::scene {

/// The first of `entity`, its parent, that one's parent, ... of which `matches` is true, or null.
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
