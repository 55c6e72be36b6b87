// SPDX-License-Identifier: MIT
#include "engine/scene/motion.h"

#include "engine/core/check.h"
#include "engine/math/transform.h"
#include "engine/scene/animation.h"
#include "engine/scene/path.h"
#include "engine/scene/placing.h"
#include "engine/scene/world.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace shutter::scene {

using math::dmat3;
using math::dmat4;
using math::dquat;
using math::dvec3;
using math::dvec4;

namespace {

struct Displacement {
    dvec3 translation{0.0};
    dquat rotation{1.0, 0.0, 0.0, 0.0};
};

/// The displacement by velocity components after `seconds`, in the parent's space.
Displacement
computeDisplacement(const ecs::Registry& registry, ecs::Entity entity, double seconds) {
    Displacement result;
    if (const auto* linear = findPlacing<LinearVelocity>(registry, entity))
        result.translation = linear->metresPerSecond * seconds;
    if (const auto* angular = findPlacing<AngularVelocity>(registry, entity))
        result.rotation = math::integrateRotation(angular->radiansPerSecond, seconds);
    return result;
}

enum class OwnScale : uint8_t { Kept, Dropped };

dmat4 parentFromEntity(const World& world, ecs::Entity entity, double seconds, OwnScale scale) {
    const ecs::Registry& registry = world.registry;
    const Displacement displacement = computeDisplacement(registry, entity, seconds);
    if (const auto* local = findPlacing<LocalMatrix>(registry, entity)) {
        dmat4 matrix = dmat4(glm::mat3_cast(displacement.rotation) * dmat3(local->matrix));
        if (scale == OwnScale::Dropped)
            matrix = math::removeScale(matrix);
        matrix[3] = local->matrix[3] + dvec4(displacement.translation, 0.0);
        return matrix;
    }
    math::Transform pose;
    if (const auto* local = findPlacing<LocalTransform>(registry, entity))
        pose = local->transform;
    if (const auto* animated = findPlacing<Animated>(registry, entity))
        pose = sampleAnimated(world.assets, world.playback, *animated, pose, seconds);
    if (const auto* path = findPlacing<PathMotion>(registry, entity))
        pose = samplePath(*path, pose, seconds);
    pose.translation += displacement.translation;
    pose.rotation = displacement.rotation * pose.rotation;
    if (scale == OwnScale::Dropped)
        pose.scale = dvec3(1.0);
    return math::computeMatrix(pose);
}

/// \param scaleOf whether an entity of the chain keeps its own scale
template <class ScaleOf>
dmat4 multiplyUpwards(
    const World& world, ecs::Entity entity, double seconds, const ScaleOf& scaleOf
) {
    const ecs::Registry& registry = world.registry;
    SHUTTER_CHECK(std::isfinite(seconds), "worldFromEntity at {} seconds", seconds);
    // Up the chain in a loop: a deep hierarchy must not overflow the stack.
    dmat4 result(1.0);
    size_t steps = 0;
    for (ecs::Entity ancestor = entity; ancestor != ecs::kNullEntity || steps == 0; ++steps) {
        SHUTTER_CHECK(
            registry.isAlive(ancestor), "{} in the chain of {} is not alive", ancestor, entity
        );
        SHUTTER_CHECK(steps < registry.aliveCount(), "the parents of {} form a cycle", entity);
        result = parentFromEntity(world, ancestor, seconds, scaleOf(ancestor)) * result;
        const auto* parent = registry.find<Parent>(ancestor);
        ancestor = parent ? parent->entity : ecs::kNullEntity;
    }
    return result;
}

} // namespace

dmat4 worldFromEntity(const World& world, ecs::Entity entity, double seconds) {
    return multiplyUpwards(world, entity, seconds, [](ecs::Entity) { return OwnScale::Kept; });
}

dmat4 worldFromRigid(const World& world, ecs::Entity entity, double seconds) {
    const dmat4 scaled = multiplyUpwards(world, entity, seconds, [&](ecs::Entity at) {
        return at == entity ? OwnScale::Dropped : OwnScale::Kept;
    });
    if (const auto rigid = math::findRigid(scaled))
        return *rigid;
    dmat4 turned = math::removeScale(multiplyUpwards(world, entity, seconds, [](ecs::Entity) {
        return OwnScale::Dropped;
    }));
    turned[3] = scaled[3];
    return turned;
}

dmat4 worldFromLight(const World& world, ecs::Entity entity, double seconds) {
    dmat4 light = worldFromEntity(world, entity, seconds);
    if (dvec3(light[2]) == dvec3(0.0))
        light[2] = worldFromRigid(world, entity, seconds)[2];
    return light;
}

bool mayMove(const World& world, ecs::Entity entity) {
    const ecs::Registry& registry = world.registry;
    return findUpwards(world, entity, [&](ecs::Entity at) {
               // Written so that NaN moves.
               const auto* linear = findPlacing<LinearVelocity>(registry, at);
               const auto* angular = findPlacing<AngularVelocity>(registry, at);
               const auto* path = findPlacing<PathMotion>(registry, at);
               return (linear && linear->metresPerSecond != dvec3(0.0)) ||
                      (angular && angular->radiansPerSecond != dvec3(0.0)) ||
                      findPlacing<Animated>(registry, at) || (path && path->keys.size() > 1);
           }) != ecs::kNullEntity;
}

} // namespace shutter::scene
