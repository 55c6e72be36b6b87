// SPDX-License-Identifier: MIT
#include "engine/scene/framing.h"

#include "engine/core/check.h"
#include "engine/math/transform.h"
#include "engine/scene/deformation.h"
#include "engine/scene/deformed_bounds.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace shutter::scene {

using math::dmat4;
using math::dquat;
using math::dvec3;

namespace {

constexpr double kYFov = std::numbers::pi / 4.0;
constexpr double kElevation = std::numbers::pi / 12.0; // the camera looks down by this angle
constexpr double kMargin = 1.1;         // of the distance, so that nothing touches the border
constexpr double kNearShare = 1e-3;     // of the distance; far below the margin
constexpr double kSmallestExtent = 1.0; // metres, for an empty scene and a point

math::Bounds chooseSubject(const math::Bounds& bounds) {
    const dvec3 size = bounds.size();
    const double extent = std::max({size.x, size.y, size.z});
    if (!bounds.isEmpty() && extent > 0.0 && std::isfinite(extent))
        return bounds;
    // A point keeps its place; the empty and the infinite scene have none.
    const bool isPoint = !bounds.isEmpty() && extent == 0.0;
    const dvec3 centre = isPoint ? bounds.centre() : dvec3(0.0);
    math::Bounds result;
    result.add(centre - dvec3(kSmallestExtent / 2.0));
    result.add(centre + dvec3(kSmallestExtent / 2.0));
    return result;
}

/// Boxes of meshes at a time, in the space of worldFromObject.
class MeshBounds {
  public:
    explicit MeshBounds(const World& world) : mWorld(world) {}

    math::Bounds find(ecs::Entity entity, AssetIndex index, double seconds) {
        const Mesh& mesh = mWorld.assets.meshes[index];
        if (!isDeformable(mWorld, entity))
            return mesh.bounds;
        const auto [entry, isNew] = mReaches.try_emplace(index);
        if (isNew)
            entry->second = computePoseReach(mesh.primitives);
        return computeDeformedBounds(entry->second, deformationAt(mWorld, entity, seconds));
    }

  private:
    const World& mWorld;
    std::map<AssetIndex, PoseReach> mReaches; // many entities may share a mesh
};

/// Smallest distance from the subject's centre at which all eight corners are in the picture.
double computeDistance(const math::Bounds& subject, const dquat& rotation, double aspect) {
    const double slopeY = std::tan(kYFov / 2.0);
    const double slopeX = slopeY * aspect;
    const dquat viewFromWorld = glm::conjugate(rotation);
    const dvec3 half = subject.size() / 2.0;
    double distance = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 sign(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0);
        const dvec3 view = viewFromWorld * (sign * half);
        const double needed = std::max(std::abs(view.x) / slopeX, std::abs(view.y) / slopeY);
        distance = std::max(distance, view.z + needed);
    }
    return distance * kMargin;
}

} // namespace

math::Bounds computeWorldBounds(const World& world, double seconds) {
    math::Bounds result;
    MeshBounds meshBounds(world);
    for (auto [entity, instance] : world.registry.view<MeshInstance>()) {
        if (instance.mesh == kNone)
            continue;
        SHUTTER_CHECK(instance.mesh < world.assets.meshes.size(), "no mesh {}", instance.mesh);
        const dmat4 worldFromMesh = worldFromObject(world, entity, seconds);
        if (!math::isFinite(worldFromMesh))
            continue; // draws nothing
        const math::Bounds bounds = meshBounds.find(entity, instance.mesh, seconds);
        result.add(math::transformBounds(worldFromMesh, bounds));
    }
    return result;
}

ecs::Entity addFramingCamera(World& world, double aspect, double seconds) {
    SHUTTER_CHECK(aspect > 0.0 && std::isfinite(aspect), "aspect is {}", aspect);
    const math::Bounds subject = chooseSubject(computeWorldBounds(world, seconds));
    math::Transform pose;
    pose.rotation = glm::angleAxis(-kElevation, dvec3(1.0, 0.0, 0.0));
    const double distance = computeDistance(subject, pose.rotation, aspect);
    pose.translation = subject.centre() + pose.rotation * dvec3(0.0, 0.0, distance);

    Camera camera;
    camera.yFov = kYFov;
    camera.near = distance * kNearShare;
    const ecs::Entity entity = world.registry.create();
    world.registry.add(entity, Name{"framing camera"});
    world.registry.add(entity, LocalTransform{pose});
    world.registry.add(entity, camera);
    world.cameras.push_back(entity);
    return entity;
}

} // namespace shutter::scene
