// SPDX-License-Identifier: MIT
#pragma once

#include "engine/math/bounds.h"
#include "engine/scene/world.h"

namespace shutter::scene {

/// World bounds of everything that is drawn, at `seconds`. Empty for an empty scene.
[[nodiscard]] math::Bounds computeWorldBounds(const World& world, double seconds);

/// Adds a camera that sees the whole scene from the front, a little above, and returns its entity.
/// It comes last in world.cameras. Works for an empty scene, a point and a kilometre. The picture's
/// aspect is width / height, above 0.
ecs::Entity addFramingCamera(World& world, double aspect, double seconds);

} // namespace shutter::scene
