// SPDX-License-Identifier: MIT
#include "engine/extract/jump_sight.h"

#include "engine/extract/deformation_keys.h"
#include "engine/extract/deformed_entity.h"
#include "engine/extract/frame_view.h"
#include "engine/extract/row_bounds.h"
#include "engine/math/transform.h"
#include "engine/scene/deformation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shutter::extract {

namespace {

using math::Bounds;
using math::dmat4;
using math::dvec3;
using scene::Jump;

/// Shortest way that is seen, of kKeyTolerancePx: a quarter of a pixel.
constexpr double kSeenTolerances = 16.0;
/// How much longer the way of a jump is than those of as much time before it and after it.
constexpr double kLeastSpeedUp = 8.0;

double findLargestScale(const dmat4& matrix) {
    return std::max(
        {glm::length(dvec3(matrix[0])),
         glm::length(dvec3(matrix[1])),
         glm::length(dvec3(matrix[2]))}
    );
}

/// Whether `way`, from the jump's one side to the other, is none that motion at the speed of its
/// surroundings takes. What steps has no length in time, and needs no comparison.
/// \param wayBetween (double from, double to) -> double, seconds to metres
template <class WayBetween>
bool isAbrupt(const Jump& jump, double way, const WayBetween& wayBetween) {
    const double length = jump.after - jump.before;
    const double rounding = 256.0 * std::numeric_limits<double>::epsilon() *
                            std::max(std::abs(jump.before), std::abs(jump.after));
    if (length <= rounding)
        return true;
    const double around = std::max(
        wayBetween(jump.before - length, jump.before), wayBetween(jump.after, jump.after + length)
    );
    return way > kLeastSpeedUp * around;
}

} // namespace

JumpSight::JumpSight(
    const scene::World& world,
    const SceneLayout& layout,
    const ViewRequest& view,
    const scene::ExposureMotion& motion
)
    : mWorld(world), mLayout(layout), mView(view), mMotion(motion),
      mCamera(world.registry.get<scene::Camera>(view.camera)) {
    const double raster = view.exposure.rasterTime;
    const bool perspective = mCamera.kind == scene::CameraKind::Perspective;
    const math::dvec2 half = glm::abs(computeHalfExtents(mCamera, motion.cameraYFov(raster), view));
    const double pixel = 2.0 * half.y / view.height;
    (perspective ? mTolerance.pixelAtOne : mTolerance.pixelAnywhere) = pixel;
    mTolerance.near = perspective ? mCamera.near : 0.0;
    mTolerance.cameraPath = {dvec3(0.0)};
    const double scale = perspective ? mCamera.near : 1.0;
    const dvec3 corner(half.x * scale, half.y * scale, mCamera.near);
    mNearView.add(-corner);
    mNearView.add(dvec3(corner.x, corner.y, 0.0));
    mEye = dvec3(motion.worldFromCamera(raster)[3]);
}

double JumpSight::shutterTimeOf(double seconds) const {
    const scene::ExposureInterval& exposure = mView.exposure;
    return (seconds - exposure.open) / (exposure.close - exposure.open);
}

dmat4 JumpSight::eyeFromCameraAt(double seconds) const {
    dmat4 view = mMotion.worldFromCamera(shutterTimeOf(seconds));
    view[3] -= math::dvec4(mEye, 0.0);
    return view;
}

std::optional<JumpSight::Posed>
JumpSight::poseAt(ecs::Entity entity, uint32_t mesh, double seconds) const {
    const double s = shutterTimeOf(seconds);
    Posed posed;
    posed.eyeFromObject = mMotion.worldFromObject(entity, s);
    if (!isDrawable(posed.eyeFromObject))
        return std::nullopt;
    posed.eyeFromObject[3] -= math::dvec4(mEye, 0.0);
    posed.bounds = mLayout.bounds[mesh];
    if (!scene::isDeformable(mWorld, entity))
        return posed;
    auto deformed = poseEntity(mMotion, entity, mLayout.reaches.at(mesh), {s, s, s});
    if (!deformed)
        return std::nullopt;
    posed.shape = std::move(deformed->raster);
    posed.bounds = deformed->bounds;
    return posed;
}

bool JumpSight::isInView(const std::optional<Posed>& posed, double seconds) const {
    if (!posed)
        return false;
    // What is not in the picture may cast a shadow into it.
    if (mView.shadows.mode != ShadowMode::None)
        return true;
    const dmat4 clipFromEye =
        makeProjection(mCamera, mMotion.cameraYFov(shutterTimeOf(seconds)), mView) *
        glm::inverse(eyeFromCameraAt(seconds));
    return !isOutsideView(clipFromEye * posed->eyeFromObject, posed->bounds);
}

double JumpSight::measureWay(const Posed& from, const Posed& to, uint32_t mesh) const {
    Bounds bounds = from.bounds;
    bounds.add(to.bounds);
    const double way = measureDeviation(from.eyeFromObject, to.eyeFromObject, bounds);
    if (from.shape.isRest())
        return way;
    return way + findLargestScale(to.eyeFromObject) *
                     measureDeformationDeviation(
                         to.shape, from.shape, from.shape, 0.5, mLayout.reaches.at(mesh)
                     );
}

bool JumpSight::sees(ecs::Entity entity, uint32_t mesh, const Jump& jump) const {
    const std::optional<Posed> before = poseAt(entity, mesh, jump.before);
    const std::optional<Posed> after = poseAt(entity, mesh, jump.after);
    const scene::ExposureInterval& exposure = mView.exposure;
    const auto isInViewAt = [&](double seconds) {
        return isInView(poseAt(entity, mesh, seconds), seconds);
    };
    if (!isInView(before, jump.before) && !isInView(after, jump.after) &&
        !isInViewAt(exposure.open) && !isInViewAt(exposure.raster) && !isInViewAt(exposure.close))
        return false;
    if (before.has_value() != after.has_value()) {
        const Posed& there = before ? *before : *after;
        const Bounds swept = math::transformBounds(there.eyeFromObject, there.bounds);
        return glm::length(swept.size()) > kSeenTolerances * mTolerance.of(swept);
    }
    if (!before)
        return false;
    Bounds swept = math::transformBounds(before->eyeFromObject, before->bounds);
    swept.add(math::transformBounds(after->eyeFromObject, after->bounds));
    const double way = measureWay(*before, *after, mesh);
    return way > kSeenTolerances * mTolerance.of(swept) &&
           isAbrupt(jump, way, [&](double from, double to) {
               const auto a = poseAt(entity, mesh, from);
               const auto b = poseAt(entity, mesh, to);
               return a && b ? measureWay(*a, *b, mesh) : 0.0;
           });
}

bool JumpSight::seesCamera(const Jump& jump) const {
    const auto wayBetween = [&](double from, double to) {
        return measureDeviation(eyeFromCameraAt(from), eyeFromCameraAt(to), mNearView);
    };
    // From the near plane a displacement shows most, and turning as much as anywhere.
    KeyTolerance nearest = mTolerance;
    nearest.cameraPath = {};
    const double way = wayBetween(jump.before, jump.after);
    return way > kSeenTolerances * nearest.of(mNearView) && isAbrupt(jump, way, wayBetween);
}

} // namespace shutter::extract
