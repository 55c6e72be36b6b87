// SPDX-License-Identifier: MIT
#include "engine/scene/camera.h"

#include "engine/core/check.h"
#include "engine/math/transform.h"
#include "engine/scene/deformation.h"
#include "engine/scene/deformed_bounds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

namespace shutter::scene {

using math::dmat3;
using math::dmat4;
using math::dquat;
using math::dvec3;

namespace {

/// Null where the camera's own field of view counts.
const LensMotion* findLensMotion(const World& world, ecs::Entity camera) {
    const bool perspective = world.registry.get<Camera>(camera).kind == CameraKind::Perspective;
    return perspective ? world.registry.find<LensMotion>(camera) : nullptr;
}

} // namespace

core::Status validateLens(const LensMotion& lens) {
    if (lens.keys.empty())
        return core::makeError("lens: it has no keys");
    for (size_t i = 0; i < lens.keys.size(); ++i) {
        const LensKey& key = lens.keys[i];
        if (!std::isfinite(key.seconds))
            return core::makeError("lens: the time of key {} is {}", i, key.seconds);
        if (i > 0 && !(key.seconds > lens.keys[i - 1].seconds))
            return core::makeError(
                "lens: key {} at {} s does not come after the one before, at {} s",
                i,
                key.seconds,
                lens.keys[i - 1].seconds
            );
        // Written so that NaN fails.
        if (!(key.yFov > 0.0 && key.yFov < std::numbers::pi))
            return core::makeError(
                "lens: the field of view of key {} is {} rad, it must lie in (0, pi)", i, key.yFov
            );
    }
    return {};
}

bool hasCutWithin(const LensMotion& lens, double from, double to) {
    return hasCutKeyWithin(lens.keys, from, to);
}

double yFovAt(const World& world, ecs::Entity camera, double seconds) {
    SHUTTER_CHECK(std::isfinite(seconds), "yFovAt {} seconds", seconds);
    const LensMotion* lens = findLensMotion(world, camera);
    if (!lens)
        return world.registry.get<Camera>(camera).yFov;
    SHUTTER_CHECK(!lens->keys.empty(), "a lens without keys");
    const KeyPlace place = findKeyPlace(lens->keys, lens->ease, seconds);
    const double from = lens->keys[place.key].yFov;
    // Relative to the key before, so that a lens at rest changes no bit.
    const double ratio =
        interpolateAtPlace<double>(lens->keys, lens->interpolation, place, [&](size_t key) {
            return std::log(std::tan(lens->keys[key].yFov / 2.0) / std::tan(from / 2.0));
        });
    return ratio == 0.0 ? from : 2.0 * std::atan(std::tan(from / 2.0) * std::exp(ratio));
}

bool mayZoom(const World& world, ecs::Entity camera) {
    const LensMotion* lens = findLensMotion(world, camera);
    return lens && std::any_of(lens->keys.begin(), lens->keys.end(), [&](const LensKey& key) {
               return key.yFov != lens->keys.front().yFov;
           });
}

namespace {

constexpr double kYFov = std::numbers::pi / 4.0;
constexpr double kElevation = std::numbers::pi / 12.0; // the camera's pitch below the horizon
constexpr double kFramingMargin = 1.1;  // of the distance, so that nothing touches the border
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
    return distance * kFramingMargin;
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

namespace {

constexpr int kIntervals = 16;
constexpr int kHalvings = 30;
/// A camera that races changes enough in many intervals at once; the largest changes are followed.
constexpr size_t kMaxFollowed = 64;

struct Interval {
    double from = 0.0;
    double to = 0.0;
    dmat4 first{1.0};
    dmat4 last{1.0};
    double change = 0.0; ///< 1: the smallest that is a cut
};

/// Turn or displacement over its threshold, whichever is larger; 0 where one is nowhere.
double measureChange(const dmat4& a, const dmat4& b, const CutDetection& detection) {
    const dmat3 turn = glm::transpose(dmat3(a)) * dmat3(b);
    const double cosine = std::clamp((turn[0][0] + turn[1][1] + turn[2][2] - 1.0) / 2.0, -1.0, 1.0);
    const double degrees = std::acos(cosine) * 180.0 / std::numbers::pi;
    const double metres = glm::length(dvec3(b[3]) - dvec3(a[3]));
    if (!std::isfinite(metres))
        return 0.0;
    return std::max(degrees / detection.degrees, metres / detection.metres);
}

class Search {
  public:
    Search(const PoseAt& poseAt, const CutDetection& detection)
        : mPoseAt(poseAt), mDetection(detection) {}

    bool run(double from, double to) {
        std::vector<Interval> open;
        double at = from;
        dmat4 pose = mPoseAt(from);
        for (int i = 1; i <= kIntervals; ++i) {
            const double next = std::lerp(from, to, double(i) / kIntervals);
            const dmat4 nextPose = mPoseAt(next);
            follow(open, at, next, pose, nextPose);
            at = next;
            pose = nextPose;
        }
        for (int i = 0; i < kHalvings && !open.empty(); ++i)
            open = halve(open);
        return !open.empty();
    }

  private:
    /// Keeps the interval if a cut may lie in it.
    void follow(
        std::vector<Interval>& open, double from, double to, const dmat4& first, const dmat4& last
    ) const {
        const double change = measureChange(first, last, mDetection);
        if (change >= 1.0)
            open.push_back({from, to, first, last, change});
    }

    [[nodiscard]] std::vector<Interval> halve(const std::vector<Interval>& intervals) const {
        std::vector<Interval> halves;
        for (const Interval& interval : intervals) {
            const double middle = std::midpoint(interval.from, interval.to);
            const dmat4 pose = mPoseAt(middle);
            follow(halves, interval.from, middle, interval.first, pose);
            follow(halves, middle, interval.to, pose, interval.last);
        }
        if (halves.size() > kMaxFollowed) {
            std::partial_sort(
                halves.begin(),
                halves.begin() + kMaxFollowed,
                halves.end(),
                [](const Interval& a, const Interval& b) { return a.change > b.change; }
            );
            halves.resize(kMaxFollowed);
        }
        return halves;
    }

    const PoseAt& mPoseAt;
    const CutDetection& mDetection;
};

} // namespace

bool findsCameraCut(const PoseAt& poseAt, double from, double to, const CutDetection& detection) {
    return detection.enabled && from < to && Search(poseAt, detection).run(from, to);
}

} // namespace shutter::scene
