// SPDX-License-Identifier: MIT
// What a ray meets first in a world, found on the CPU among the triangles themselves.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/world.h"

#include <optional>

namespace shutter::scene {

struct WorldRay {
    math::dvec3 origin{0.0};               ///< metres, world space
    math::dvec3 direction{0.0, 0.0, -1.0}; ///< unit length
    double least = 0.0; ///< metres from the origin: nothing nearer is met, 0 or more
};

struct SurfaceHit {
    ecs::Entity entity;
    double distance = 0.0; ///< from the origin, metres
};

/// The nearest surface that is drawn at `seconds` (finite): deformed as it is then, and from its
/// front unless its material has two sides or it is skinned. Blended surfaces are ignored;
/// masked ones are met where their textures have holes, too. Nothing where the ray meets none.
/// Tests all triangles of meshes whose box the ray enters: for a click, not for a picture.
[[nodiscard]] std::optional<SurfaceHit>
castRay(const World& world, const WorldRay& ray, double seconds);

/// Distance along the axis of what the camera sees in the middle of its picture, metres. Nothing
/// where that is the sky.
[[nodiscard]] std::optional<double>
findMiddleDistance(const World& world, ecs::Entity camera, double seconds);

} // namespace shutter::scene
