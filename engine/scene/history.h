// SPDX-License-Identifier: MIT
// Events that end an entity's past. The game reports them with their times; an entity without a
// past within a frame has no motion of its own in it (exposure_motion.h).
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/transform.h"
#include "engine/scene/world.h"

#include <limits>

namespace shutter::scene {

/// Times after `after` and not after `until`, seconds. Half-open interval (after, until]: an event
/// at `after` is over: all that the span sees comes later.
struct TimeSpan {
    double after = 0.0;
    double until = 0.0;

    [[nodiscard]] bool contains(double seconds) const {
        return seconds > after && seconds <= until;
    }
};

/// Puts the entity at `transform` of its parent's space at `seconds` (finite); its velocities go on
/// from there. Properties driven by a clip or a path still override it: put such an entity under a
/// parent and teleport the parent.
void teleport(World& world, ecs::Entity entity, const math::Transform& transform, double seconds);
/// As teleport(), of a camera, and everything is static in that frame.
void cutTo(World& world, ecs::Entity camera, const math::Transform& transform, double seconds);
/// Declares a cut to this camera, or to an unrelated view of it.
void cut(World& world, ecs::Entity camera, double seconds);
/// The entity was made at `seconds`.
void appear(World& world, ecs::Entity entity, double seconds);
/// Hides the entity and its descendants at all times.
void hide(World& world, ecs::Entity entity);
/// The same from `seconds` on (finite): until then they are drawn, also in an exposure that it lies
/// in.
void hide(World& world, ecs::Entity entity, double seconds);
/// Draws them again, from `seconds` on.
void show(World& world, ecs::Entity entity, double seconds);
/// Destroys the entity, its descendants and skinned meshes that hang on one of them; cameras leave
/// World::cameras.
void despawn(World& world, ecs::Entity entity);

/// True for an entity that is hidden at `seconds`, and for descendants of one; by default for one
/// that is at some time.
[[nodiscard]] bool isHidden(
    const World& world, ecs::Entity entity, double seconds = std::numeric_limits<double>::infinity()
);

/// True for one that is hidden at all times.
[[nodiscard]] bool isAlwaysHidden(const World& world, ecs::Entity entity);

/// True when the entity or an ancestor appears after `seconds`, or is hidden from some time on.
[[nodiscard]] bool mayComeOrGo(const World& world, ecs::Entity entity, double seconds);

/// True when the entity or an ancestor appeared, was teleported, or has a path that jumps, in
/// `span`.
[[nodiscard]] bool hasNoPast(const World& world, ecs::Entity entity, const TimeSpan& span);

/// True when the picture of `camera` was cut in `span`, by CameraCut, by a cut of its lens, its
/// path or its parents', or because the world began in it or begins later.
[[nodiscard]] bool isCut(const World& world, ecs::Entity camera, const TimeSpan& span);

} // namespace shutter::scene
