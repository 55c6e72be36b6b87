// SPDX-License-Identifier: MIT
// The components that determine an entity's placement, motion, blur scale and time of appearance.
// Caches of derived data watch them for changes (extract::WorldWatch).
#pragma once

#include "engine/ecs/registry.h"
#include "engine/scene/components.h"
#include "engine/scene/path.h"

#include <type_traits>

namespace shutter::scene {

template <class... Components> struct ComponentList {
    template <class T> static constexpr bool holds = (std::is_same_v<T, Components> || ...);
};

/// Besides Parent and Hidden, which concern more than one entity.
using PlacingComponents = ComponentList<
    LocalTransform,
    LocalMatrix,
    LinearVelocity,
    AngularVelocity,
    Animated,
    PathMotion,
    MotionBlur,
    Appeared>;

/// Null: the entity has none. Functions of placement read components through it, so that none of
/// them reads an unwatched one.
template <class T>
requires PlacingComponents::holds<T>

[[nodiscard]] const T* findPlacing(const ecs::Registry& registry, ecs::Entity entity) {
    return registry.find<T>(entity);
}

} // namespace shutter::scene
