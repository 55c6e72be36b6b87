// SPDX-License-Identifier: MIT
#include "engine/extract/deformed_entity.h"

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

} // namespace

bool isFinite(const scene::Deformation& pose, const scene::PoseReach& reach) {
    for (size_t joint = 0; joint < pose.objectFromBind.size(); ++joint)
        if (deformsAnything(reach, joint) && !math::isFinite(pose.objectFromBind[joint]))
            return false;
    return std::all_of(pose.morphWeights.begin(), pose.morphWeights.end(), [](double weight) {
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
    return a.objectFromBind == b.objectFromBind && a.morphWeights == b.morphWeights;
}

std::optional<DeformedEntity> poseEntity(
    const scene::ExposureMotion& motion,
    ecs::Entity entity,
    const scene::PoseReach& reach,
    const DeformationTimes& times
) {
    DeformedEntity result;
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
    result.changes = !isSame(result.open, result.raster) || !isSame(result.close, result.raster);
    result.mirrored = isMirrored(result.raster, reach);
    result.bounds = scene::computeDeformedBounds(reach, result.raster);
    for (int axis = 0; axis < 3; ++axis)
        // Written so that NaN is not drawn.
        if (!(result.bounds.min[axis] > -kFarthest) || !(result.bounds.max[axis] < kFarthest))
            return std::nullopt;
    if (result.bounds.isEmpty())
        return std::nullopt;
    return result;
}

} // namespace shutter::extract
