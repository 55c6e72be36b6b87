// SPDX-License-Identifier: MIT
#include "engine/scene/ray_cast.h"

#include "engine/scene/deformation.h"
#include "engine/scene/history.h"
#include "engine/scene/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace shutter::scene {

namespace {

using math::dmat4;
using math::dvec3;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// In the space of a mesh, of the same parameter as in the world.
struct MeshRay {
    dvec3 origin{0.0};
    dvec3 direction{0.0};
    double least = 0.0;
    double most = kNever;
};

bool entersBox(const MeshRay& ray, const math::Bounds& box) {
    if (box.isEmpty())
        return false;
    double enter = ray.least;
    double leave = ray.most;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min[axis] - ray.origin[axis]) / ray.direction[axis];
        const double b = (box.max[axis] - ray.origin[axis]) / ray.direction[axis];
        // 0 / 0, in the plane of a side: no limit.
        if (std::isnan(a) || std::isnan(b))
            continue;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    // A flat mesh's box has no inside.
    return enter <= leave + 1.0e-9 * std::abs(leave);
}

double shareOfWaves(const WaveShares& shares, const dvec3& place, const math::vec4* color) {
    double share = 1.0;
    if (shares.share == WaveShare::Height)
        share = glm::dot(dvec3(shares.height), place) + shares.height.w;
    else if (shares.share == WaveShare::Color)
        share = color ? double((*color)[glm::length_t(shares.channel)]) : 1.0;
    return std::pow(std::clamp(share, 0.0, 1.0), shares.exponent);
}

dvec3 deform(const Primitive& primitive, const Deformation& shape, size_t vertex) {
    dvec3 place(primitive.positions[vertex]);
    for (size_t i = 0; i < shape.morphWeights.size() && i < primitive.morphTargets.size(); ++i)
        if (const auto& deltas = primitive.morphTargets[i].positions; !deltas.empty())
            place += shape.morphWeights[i] * dvec3(deltas[vertex]);
    if (!shape.waves.waves.empty()) {
        const auto* color = primitive.colors.empty() ? nullptr : &primitive.colors[vertex];
        const double share = shareOfWaves(shape.waves.shares, place, color);
        dvec3 moved = place;
        for (const WavePose::Wave& wave : shape.waves.waves)
            moved +=
                share * std::sin(wave.phase - glm::dot(wave.waveVector, place)) * wave.displacement;
        place = moved;
    }
    if (shape.objectFromBind.empty() || primitive.influenceCount == 0)
        return place;
    dvec3 skinned(0.0);
    for (uint32_t i = 0; i < primitive.influenceCount; ++i) {
        const size_t at = vertex * primitive.influenceCount + i;
        if (primitive.weights[at] > 0.0f)
            skinned += double(primitive.weights[at]) *
                       dvec3(shape.objectFromBind[primitive.joints[at]] * math::dvec4(place, 1.0));
    }
    return skinned;
}

/// Möller and Trumbore's. \param turns 1: fronts count, -1: backs do, 0: both
double meetTriangle(const MeshRay& ray, const std::array<dvec3, 3>& corners, double turns) {
    const dvec3 along = corners[1] - corners[0];
    const dvec3 across = corners[2] - corners[0];
    const dvec3 p = glm::cross(ray.direction, across);
    const double det = glm::dot(along, p);
    if (det == 0.0 || det * turns < 0.0)
        return kNever;
    const dvec3 from = ray.origin - corners[0];
    const double u = glm::dot(from, p) / det;
    const dvec3 q = glm::cross(from, along);
    const double v = glm::dot(ray.direction, q) / det;
    const double at = glm::dot(across, q) / det;
    // Written so that NaN fails.
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at >= ray.least && at < ray.most ? at : kNever;
}

void meetPrimitive(
    const Primitive& primitive, const Deformation& shape, double turns, MeshRay& ray
) {
    const bool isRest = shape.isRest();
    for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        std::array<dvec3, 3> corners;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t vertex = primitive.indices[i + k];
            corners[k] =
                isRest ? dvec3(primitive.positions[vertex]) : deform(primitive, shape, vertex);
        }
        ray.most = std::min(ray.most, meetTriangle(ray, corners, turns));
    }
}

/// Shortens the ray to where it meets the entity's mesh.
void meetMesh(const World& world, ecs::Entity entity, double seconds, MeshRay& ray) {
    const auto& instance = world.registry.get<MeshInstance>(entity);
    if (instance.mesh >= world.assets.meshes.size())
        return;
    const Mesh& mesh = world.assets.meshes[instance.mesh];
    const dmat4 meshFromWorld = glm::inverse(worldFromObject(world, entity, seconds));
    if (!math::isFinite(meshFromWorld))
        return;
    const Deformation shape = deformationAt(world, entity, seconds);
    MeshRay local{
        dvec3(meshFromWorld * math::dvec4(ray.origin, 1.0)),
        dvec3(meshFromWorld * math::dvec4(ray.direction, 0.0)),
        ray.least,
        ray.most};
    if (shape.isRest() && !entersBox(local, mesh.bounds))
        return;
    // A mirror turns the winding and the side that is drawn: in the mesh's space nothing turns.
    const double front = shape.objectFromBind.empty() ? 1.0 : 0.0;
    for (const Primitive& primitive : mesh.primitives) {
        const Material* material = primitive.material < world.assets.materials.size()
                                       ? &world.assets.materials[primitive.material]
                                       : nullptr;
        if (material && material->alphaMode == AlphaMode::Blend)
            continue;
        meetPrimitive(primitive, shape, material && material->doubleSided ? 0.0 : front, local);
    }
    ray.most = local.most;
}

bool isThere(const World& world, ecs::Entity entity, double seconds) {
    if (isHidden(world, entity, seconds))
        return false;
    return findUpwards(world, entity, [&](ecs::Entity at) {
               const auto* appeared = world.registry.find<Appeared>(at);
               return appeared && appeared->seconds > seconds;
           }) == ecs::kNullEntity;
}

} // namespace

std::optional<SurfaceHit> castRay(const World& world, const WorldRay& ray, double seconds) {
    MeshRay rest{ray.origin, ray.direction, ray.least, kNever};
    ecs::Entity nearest;
    for (auto [entity, instance] : world.registry.view<MeshInstance>()) {
        (void)instance;
        if (!isThere(world, entity, seconds))
            continue;
        const double before = rest.most;
        meetMesh(world, entity, seconds, rest);
        if (rest.most < before)
            nearest = entity;
    }
    if (!std::isfinite(rest.most))
        return std::nullopt;
    return SurfaceHit{nearest, rest.most};
}

std::optional<double> findMiddleDistance(const World& world, ecs::Entity camera, double seconds) {
    const dmat4 view = worldFromRigid(world, camera, seconds);
    const auto hit = castRay(
        world, {dvec3(view[3]), -dvec3(view[2]), world.registry.get<Camera>(camera).near}, seconds
    );
    return hit ? std::optional(hit->distance) : std::nullopt;
}

} // namespace shutter::scene
