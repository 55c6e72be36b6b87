// SPDX-License-Identifier: MIT
#include "engine/extract/deformed_entity.h"

#include "engine/extract/deformation_keys.h"
#include "engine/math/transform.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace shutter::extract {

namespace {

/// Metres from the object's origin: builders of acceleration structures lose themselves beyond.
constexpr double kFarthest = 1.0e18;

bool deformsAnything(const scene::PoseReach& reach, size_t joint) {
    return joint < reach.joints.size() && !reach.joints[joint].isEmpty();
}

/// The joint of the pose whose matrix is the farthest from being singular, among those that deform
/// anything; nothing: there is none, or all are singular.
std::optional<uint32_t>
findSteadiest(const scene::Deformation& pose, const scene::PoseReach& reach) {
    std::optional<uint32_t> steadiest;
    double best = 0.0;
    for (size_t joint = 0; joint < pose.objectFromBind.size(); ++joint) {
        if (!deformsAnything(reach, joint))
            continue;
        const math::dmat3 axes(pose.objectFromBind[joint]);
        const double longest =
            std::max({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
        const double steadiness =
            std::abs(glm::determinant(axes)) / std::max(longest * longest * longest, 1.0e-300);
        if (!(steadiness > best))
            continue;
        best = steadiness;
        steadiest = static_cast<uint32_t>(joint);
    }
    return steadiest;
}

/// A carrier of the raster instant's shape to both ends.
std::optional<uint32_t>
findCarrierToEnds(const DeformedEntity& shape, const scene::PoseReach& reach, double tolerance) {
    const auto open = findCarrier(shape.raster, shape.open, reach, tolerance);
    return open && findCarrier(shape.raster, shape.close, reach, tolerance) ? open : std::nullopt;
}

} // namespace

bool isFinite(const scene::Deformation& pose, const scene::PoseReach& reach) {
    for (size_t joint = 0; joint < pose.objectFromBind.size(); ++joint)
        if (deformsAnything(reach, joint) && !math::isFinite(pose.objectFromBind[joint]))
            return false;
    return scene::isFinite(pose.waves) &&
           std::all_of(pose.morphWeights.begin(), pose.morphWeights.end(), [](double weight) {
               return std::isfinite(weight);
           });
}

bool isMirrored(const scene::Deformation& pose, const scene::PoseReach& reach) {
    int64_t mirrored = 0;
    for (size_t joint = 0; joint < pose.objectFromBind.size(); ++joint) {
        if (!deformsAnything(reach, joint))
            continue;
        const double determinant = glm::determinant(math::dmat3(pose.objectFromBind[joint]));
        mirrored += (determinant < 0.0) - (determinant > 0.0);
    }
    return mirrored > 0;
}

bool isSame(const scene::Deformation& a, const scene::Deformation& b) {
    return a.objectFromBind == b.objectFromBind && a.morphWeights == b.morphWeights &&
           a.waves.waves == b.waves.waves;
}

double measureRounding(const math::Bounds& bounds) {
    constexpr double kHalfUlp = 0x1p-24;
    if (bounds.isEmpty())
        return 0.0;
    const math::dvec3 farthest = glm::max(glm::abs(bounds.min), glm::abs(bounds.max));
    return kHalfUlp * std::max({farthest.x, farthest.y, farthest.z});
}

bool isNear(
    const scene::Deformation& a,
    const scene::Deformation& b,
    const scene::PoseReach& reach,
    double tolerance
) {
    // Written so that NaN is not near.
    return isSame(a, b) || measureDeformationDeviation(a, b, b, 0.0, reach) <= tolerance;
}

std::optional<uint32_t> findCarrier(
    const scene::Deformation& from,
    const scene::Deformation& to,
    const scene::PoseReach& reach,
    double tolerance
) {
    const std::optional<uint32_t> joint = findSteadiest(from, reach);
    if (!joint)
        return std::nullopt;
    const math::dmat4 carries =
        to.objectFromBind[*joint] * glm::inverse(from.objectFromBind[*joint]);
    scene::Deformation carried = from;
    for (math::dmat4& matrix : carried.objectFromBind)
        matrix = carries * matrix;
    return isNear(to, carried, reach, tolerance) ? joint : std::nullopt;
}

std::optional<DeformedEntity> poseEntity(
    const scene::ExposureMotion& motion,
    ecs::Entity entity,
    const scene::PoseReach& reach,
    const ShutterTimes& times
) {
    DeformedEntity result;
    result.reach = &reach;
    result.raster = motion.deformationAt(entity, times.raster);
    if (!isFinite(result.raster, reach))
        return std::nullopt;
    const bool mayDeform = motion.mayDeform(entity);
    const auto poseAt = [&](double s) {
        return mayDeform && s != times.raster ? motion.deformationAt(entity, s) : result.raster;
    };
    result.open = poseAt(times.open);
    result.close = poseAt(times.close);
    if (!isFinite(result.open, reach) || !isFinite(result.close, reach))
        return std::nullopt;
    result.mirrored = isMirrored(result.raster, reach);
    result.bounds = scene::computeDeformedBounds(reach, result.raster);
    for (int axis = 0; axis < 3; ++axis)
        // Written so that NaN is not drawn.
        if (!(result.bounds.min[axis] > -kFarthest) || !(result.bounds.max[axis] < kFarthest))
            return std::nullopt;
    if (result.bounds.isEmpty())
        return std::nullopt;
    const double rounding = measureRounding(result.bounds);
    result.changes = !isNear(result.open, result.raster, reach, rounding) ||
                     !isNear(result.close, result.raster, reach, rounding);
    if (result.changes)
        result.carrier = findCarrierToEnds(result, reach, rounding);
    return result;
}

} // namespace shutter::extract
