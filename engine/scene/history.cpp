// SPDX-License-Identifier: MIT
#include "engine/scene/history.h"

#include "engine/core/check.h"
#include "engine/scene/camera.h"
#include "engine/scene/lens.h"
#include "engine/scene/path.h"
#include "engine/scene/placing.h"
#include "engine/scene/world.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace shutter::scene {

namespace {

template <class Event> void stamp(World& world, ecs::Entity entity, double seconds) {
    SHUTTER_CHECK(std::isfinite(seconds), "an event of {} at {} seconds", entity, seconds);
    world.registry.add(entity, Event{seconds});
}

template <class Event> bool happened(const World& world, ecs::Entity entity, const TimeSpan& span) {
    const auto* event = world.registry.find<Event>(entity);
    return event && span.contains(event->seconds);
}

bool hasPathCut(const World& world, ecs::Entity entity, const TimeSpan& span) {
    const auto* path = world.registry.find<PathMotion>(entity);
    return path && hasCutWithin(*path, span.after, span.until);
}

bool isAbove(const World& world, ecs::Entity ancestor, ecs::Entity entity) {
    return findUpwards(world, entity, [&](ecs::Entity at) { return at == ancestor; }) !=
           ecs::kNullEntity;
}

} // namespace

void teleport(World& world, ecs::Entity entity, const math::Transform& transform, double seconds) {
    ecs::Registry& registry = world.registry;
    stamp<Teleported>(world, entity, seconds);
    // Velocities are counted from time 0: where was it then, to be there now?
    math::Transform rest = transform;
    if (const auto* linear = registry.find<LinearVelocity>(entity))
        rest.translation -= linear->metresPerSecond * seconds;
    if (const auto* angular = registry.find<AngularVelocity>(entity))
        rest.rotation =
            math::integrateRotation(angular->radiansPerSecond, -seconds) * transform.rotation;
    registry.remove<LocalMatrix>(entity);
    registry.add(entity, LocalTransform{rest});
}

void cutTo(World& world, ecs::Entity camera, const math::Transform& transform, double seconds) {
    teleport(world, camera, transform, seconds);
    cut(world, camera, seconds);
}

void cut(World& world, ecs::Entity camera, double seconds) {
    stamp<CameraCut>(world, camera, seconds);
}

void appear(World& world, ecs::Entity entity, double seconds) {
    stamp<Appeared>(world, entity, seconds);
}

void hide(World& world, ecs::Entity entity) {
    world.registry.add(entity, Hidden{});
}

void hide(World& world, ecs::Entity entity, double seconds) {
    stamp<Hidden>(world, entity, seconds);
}

void show(World& world, ecs::Entity entity, double seconds) {
    if (world.registry.remove<Hidden>(entity))
        appear(world, entity, seconds);
}

void despawn(World& world, ecs::Entity entity) {
    const ecs::Registry& registry = world.registry;
    std::vector<ecs::Entity> doomed;
    for (const ecs::Entity other : registry.entities()) {
        const auto* skinned = registry.find<Skinned>(other);
        const bool loosesSkeleton =
            skinned &&
            std::any_of(skinned->joints.begin(), skinned->joints.end(), [&](ecs::Entity joint) {
                return isAbove(world, entity, joint);
            });
        if (loosesSkeleton || isAbove(world, entity, other))
            doomed.push_back(other);
    }
    for (const ecs::Entity other : doomed) {
        std::erase(world.cameras, other);
        world.registry.destroy(other);
    }
}

bool isHidden(const World& world, ecs::Entity entity, double seconds) {
    return findUpwards(world, entity, [&](ecs::Entity at) {
               const auto* hidden = world.registry.find<Hidden>(at);
               return hidden && hidden->seconds <= seconds;
           }) != ecs::kNullEntity;
}

bool isAlwaysHidden(const World& world, ecs::Entity entity) {
    return isHidden(world, entity, -std::numeric_limits<double>::infinity());
}

bool mayComeOrGo(const World& world, ecs::Entity entity, double seconds) {
    return findUpwards(world, entity, [&](ecs::Entity at) {
               const auto* appeared = findPlacing<Appeared>(world.registry, at);
               const auto* hidden = world.registry.find<Hidden>(at);
               return (appeared && appeared->seconds > seconds) ||
                      (hidden && std::isfinite(hidden->seconds));
           }) != ecs::kNullEntity;
}

bool hasNoPast(const World& world, ecs::Entity entity, const TimeSpan& span) {
    return findUpwards(world, entity, [&](ecs::Entity at) {
               return happened<Appeared>(world, at, span) ||
                      happened<Teleported>(world, at, span) || hasPathCut(world, at, span);
           }) != ecs::kNullEntity;
}

bool isCut(const World& world, ecs::Entity camera, const TimeSpan& span) {
    if (world.startSeconds > span.after || happened<CameraCut>(world, camera, span))
        return true;
    const auto* lens = world.registry.find<LensMotion>(camera);
    if (lens && hasCutWithin(*lens, span.after, span.until))
        return true;
    const auto* focus = world.registry.find<FocusMotion>(camera);
    if (focus && hasCutKeyWithin(focus->keys, span.after, span.until))
        return true;
    return findUpwards(world, camera, [&](ecs::Entity at) {
               return hasPathCut(world, at, span);
           }) != ecs::kNullEntity;
}

} // namespace shutter::scene
