// SPDX-License-Identifier: MIT
#include "engine/extract/frame_view.h"

#include "engine/extract/extracted_frame.h"
#include "engine/math/transform.h"
#include "engine/scene/camera.h"
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"
#include "engine/scene/shutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace shutter::extract {

namespace {

using math::dmat4;
using math::dvec2;
using math::dvec3;
using math::dvec4;

static_assert(sizeof(ViewMatrices) == (4 * 16 + 3) * sizeof(double), "compared by its bytes");

ShutterTimes findPoseTimes(const ViewRequest& request) {
    if (request.instant)
        return {*request.instant, *request.instant, *request.instant};
    if (request.part)
        return *request.part;
    return {0.0, request.exposure.rasterTime, 1.0};
}

/// Clip space moved by a part of a pixel, for sampling inside it.
dmat4 jitterClip(const ViewRequest& request) {
    const math::dvec2 shift =
        -2.0 * request.jitterPx / math::dvec2(double(request.width), double(request.height));
    return glm::translate(dmat4(1.0), dvec3(shift, 0.0));
}

bool isIdentical(const dmat4& a, const dmat4& b) {
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}

double computeAspect(const ViewRequest& view) {
    return double(view.width) / view.height;
}

/// By more than what files round: a frame of the picture's own shape changes no bit.
bool isWiderThanPicture(double frameAspect, const ViewRequest& view) {
    constexpr double kRounding = 1.0e-6;
    return frameAspect > computeAspect(view) * (1.0 + kRounding);
}

/// How much higher than a perspective camera's frame the picture is.
double findHeightening(const scene::Camera& camera, const ViewRequest& view) {
    const bool grows = view.frameFit == FrameFit::Whole && camera.aspectRatio &&
                       isWiderThanPicture(*camera.aspectRatio, view);
    return grows ? *camera.aspectRatio / computeAspect(view) : 1.0;
}

} // namespace

ViewRequest withoutStaticSamples(const ViewRequest& view) {
    ViewRequest centred = view;
    if (view.jittered == Jittered::Static) {
        centred.jittered = Jittered::All;
        centred.jitterPx = dvec2(0.0);
        centred.staticLodBias = 0.0f;
    }
    return centred;
}

dvec2 computeHalfExtents(const scene::Camera& camera, double yFov, const ViewRequest& view) {
    const double aspect = computeAspect(view);
    if (camera.kind == scene::CameraKind::Perspective) {
        const double halfHeight = std::tan(yFov / 2.0) * findHeightening(camera, view);
        return {halfHeight * aspect, halfHeight};
    }
    const double xMag = std::abs(camera.xMag);
    const double yMag = std::abs(camera.yMag);
    const bool isWider = view.frameFit == FrameFit::Whole && isWiderThanPicture(xMag / yMag, view);
    const double halfHeight = isWider ? xMag / aspect : yMag;
    return {
        std::copysign(halfHeight * aspect, camera.xMag), std::copysign(halfHeight, camera.yMag)};
}

double computePictureYFov(const scene::Camera& camera, double yFov, const ViewRequest& view) {
    const double heightening = findHeightening(camera, view);
    return heightening == 1.0 ? yFov : 2.0 * std::atan(std::tan(yFov / 2.0) * heightening);
}

dmat4 makeProjection(const scene::Camera& camera, double yFov, const ViewRequest& view) {
    if (camera.kind == scene::CameraKind::Perspective)
        return math::clipFromViewPerspective(
            computePictureYFov(camera, yFov, view), computeAspect(view), camera.near
        );
    const dvec2 half = computeHalfExtents(camera, yFov, view);
    return math::clipFromViewOrthographic(half.x, half.y, camera.near, camera.far);
}

math::ThinLens describeLens(
    const scene::ExposureMotion& motion,
    const scene::Camera& camera,
    const ViewRequest& view,
    double s
) {
    const scene::CameraLens& lens = motion.cameraLens(s);
    const double yFov = motion.cameraYFov(s);
    return {
        math::measurePixelsPerUnit(makeProjection(camera, yFov, view), {view.width, view.height}),
        scene::computeLensRadius(lens, yFov),
        lens.focusDistance,
        scene::describeAperture(lens)};
}

CameraPose placeCamera(
    const scene::ExposureMotion& motion,
    const scene::Camera& camera,
    const ViewRequest& view,
    double s
) {
    const double yFov = motion.cameraYFov(s);
    CameraPose pose{motion.worldFromCamera(s), makeProjection(camera, yFov, view)};
    if (!view.lensPlace)
        return pose;
    const scene::CameraLens lens = motion.cameraLens(s);
    const double radius = scene::computeLensRadius(lens, yFov);
    if (radius == 0.0)
        return pose;
    const dvec2 place =
        radius * dvec2(shader::aperturePoint(scene::describeAperture(lens), *view.lensPlace));
    pose.worldFromView *= glm::translate(dmat4(1.0), dvec3(place, 0.0));
    dmat4 shear(1.0); // x / z grows by place / focusDistance, whatever z
    shear[2] -= dvec4(place / lens.focusDistance, 0.0, 0.0);
    pose.clipFromView *= shear;
    return pose;
}

bool isDrawable(const math::dmat4& matrix) {
    const double determinant = glm::determinant(math::dmat3(matrix));
    return math::isFinite(matrix) && std::isfinite(determinant) && determinant != 0.0;
}

shader::LightRow makeLight(const scene::Light& light, const dmat4& world, const dvec3& origin) {
    shader::LightRow row{};
    const dvec3 direction = -dvec3(world[2]);
    const double size = glm::length(direction);
    const dvec3 unit = size > 0.0 ? direction / size : dvec3(0.0, 0.0, -1.0);
    const float range = std::isfinite(light.range) ? light.range : 0.0f;
    row.positionRange = math::vec4(math::vec3(dvec3(world[3]) - origin), range);
    row.direction = math::vec4(math::vec3(unit), 0.0f);
    row.radiance = math::vec4(light.color * light.intensity, 0.0f);
    row.kind = static_cast<uint32_t>(light.kind);
    // KHR_lights_punctual, "Inner and Outer Cone Angles".
    const float outer = std::cos(light.outerConeAngle);
    row.spotScale = 1.0f / std::max(0.001f, std::cos(light.innerConeAngle) - outer);
    row.spotOffset = -outer * row.spotScale;
    return row;
}

bool isIdentical(const ViewMatrices& a, const ViewMatrices& b) {
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}

FrameView::FrameView(const scene::World& world, const ViewRequest& request)
    : mMotion(world, request.camera, request.exposure), mTimes(findPoseTimes(request)) {
    if (request.jittered == Jittered::Static)
        mBefore.emplace(world, request.camera, scene::computeExposureBefore(request.exposure, 1));
    const auto& camera = world.registry.get<scene::Camera>(request.camera);
    const std::array times{mTimes.open, mTimes.raster, mTimes.close};
    for (int i = 0; i < 3; ++i) {
        const auto [worldFromView, clipFromView] = placeCamera(mMotion, camera, request, times[i]);
        mClipFromView[i] = clipFromView;
        mViewFromWorld[i] = glm::inverse(worldFromView);
        mEye[i] = dvec3(worldFromView[3]);
        if (i == 1)
            mForward = -glm::normalize(dvec3(worldFromView[2]));
    }
    mMatrices.clipFromWorldOpen = mClipFromView[0] * mViewFromWorld[0];
    mMatrices.clipFromWorldRaster = mClipFromView[1] * mViewFromWorld[1];
    mMatrices.clipFromWorldClose = mClipFromView[2] * mViewFromWorld[2];
    mIsCameraAtRest = mBefore && findCameraAtRest(request);
    const bool jitters = request.jittered == Jittered::All || mIsCameraAtRest;
    mMatrices.clipFromWorldJittered = jitters ? jitterClip(request) * mMatrices.clipFromWorldRaster
                                              : mMatrices.clipFromWorldRaster;
    mMatrices.eye = mEye[1];
    fillConstants(camera, request);
    if (jitters)
        mConstants.staticLodBias += request.staticLodBias;
}

bool FrameView::findCameraAtRest(const ViewRequest& request) const {
    const double before = mBefore->exposure().rasterTime;
    return isIdentical(mMatrices.clipFromWorldOpen, mMatrices.clipFromWorldRaster) &&
           isIdentical(mMatrices.clipFromWorldClose, mMatrices.clipFromWorldRaster) &&
           mBefore->worldFromCamera(before) ==
               mMotion.worldFromCamera(request.exposure.rasterTime) &&
           mBefore->cameraYFov(before) == mMotion.cameraYFov(request.exposure.rasterTime);
}

void FrameView::fillConstants(const scene::Camera& camera, const ViewRequest& request) {
    const dmat4 worldFromRelWorld = glm::translate(dmat4(1.0), mEye[1]);
    const dmat4 clipFromRelWorld = mMatrices.clipFromWorldJittered * worldFromRelWorld;
    // The translation is a difference of eyes, so that it is exact far from the world's origin.
    const auto clipFromRelWorldAt = [&](int i) {
        return math::mat4(
            mClipFromView[i] * dmat4(math::dmat3(mViewFromWorld[i])) *
            glm::translate(dmat4(1.0), mEye[1] - mEye[i])
        );
    };
    mConstants.clipFromRelWorld = math::mat4(clipFromRelWorld);
    mConstants.relWorldFromClip = math::mat4(glm::inverse(clipFromRelWorld));
    mConstants.clipFromRelWorldOpen = clipFromRelWorldAt(0);
    mConstants.clipFromRelWorldClose = clipFromRelWorldAt(2);
    const bool perspective = camera.kind == scene::CameraKind::Perspective;
    // Clip w is the distance for a perspective camera and 1 for an orthographic one.
    const double minW = perspective ? camera.near : 0.5;
    mConstants.forward = math::vec4(math::vec3(mForward), float(minW));
    mConstants.background = math::vec4(request.background, 1.0f);
    mConstants.ambient = math::vec4(request.ambient, 1.0f);
    mConstants.sizePx = {float(request.width), float(request.height)};
    const dvec2 half = computeHalfExtents(camera, mMotion.cameraYFov(mTimes.raster), request);
    const auto footprint = float(2.0 * std::abs(half.y) / double(request.height));
    mConstants.pixelFootprint =
        perspective ? math::vec2(footprint, 0.0f) : math::vec2(0.0f, footprint);
    mMirrors = half.x * half.y < 0.0;
    mConstants.lodBias = mConstants.staticLodBias = request.lodBias;
    mConstants.flags = request.unlit ? shader::kFrameUnlit : 0u;
    // Motion that ends where it began is detected at the raster instant.
    const math::mat4 unmoved = clipFromRelWorldAt(1);
    mMoves = mConstants.clipFromRelWorldOpen != unmoved ||
             mConstants.clipFromRelWorldClose != unmoved || mEye[0] != mEye[1] ||
             mEye[2] != mEye[1];
}

bool isDrawable(const ObjectPoses& poses) {
    return isDrawable(poses.raster) &&
           (poses.still || (math::isFinite(poses.open) && math::isFinite(poses.close)));
}

PlacedEntity placeEntity(
    const ViewMatrices& view,
    const ObjectPoses& poses,
    const math::Bounds& bounds,
    bool shapeChanges
) {
    PlacedEntity placed;
    const dmat4& clipFromWorld =
        poses.jitters ? view.clipFromWorldJittered : view.clipFromWorldRaster;
    const dmat4 clipRaster = clipFromWorld * poses.raster;
    placed.row.clipFromObjectRaster = math::mat4(clipRaster);
    dmat4 eye = poses.raster;
    eye[3] -= dvec4(view.eye, 0.0);
    for (int i = 0; i < 3; ++i)
        placed.row.relWorldFromObject[i] = math::vec4(eye[0][i], eye[1][i], eye[2][i], eye[3][i]);
    placed.row.motion = shader::kNoMotion;

    const bool still = poses.still &&
                       isIdentical(view.clipFromWorldOpen, view.clipFromWorldRaster) &&
                       isIdentical(view.clipFromWorldClose, view.clipFromWorldRaster);
    if (!still || shapeChanges) {
        placed.motion.clipFromObjectOpen = math::mat4(view.clipFromWorldOpen * poses.open);
        placed.motion.clipFromObjectClose = math::mat4(view.clipFromWorldClose * poses.close);
        const math::mat4 unjittered(view.clipFromWorldRaster * poses.raster);
        placed.moves = shapeChanges || placed.motion.clipFromObjectOpen != unjittered ||
                       placed.motion.clipFromObjectClose != unjittered;
    }
    placed.visible = !isOutsideView(clipRaster, bounds);
    const double distance = glm::length(dvec3(eye * dvec4(bounds.centre(), 1.0)));
    // A camera that is nowhere sees all from as far: draws are sorted by this.
    placed.distance =
        std::isnan(distance) ? std::numeric_limits<float>::infinity() : float(distance);
    return placed;
}

} // namespace shutter::extract
