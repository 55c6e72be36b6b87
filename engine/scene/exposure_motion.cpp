// SPDX-License-Identifier: MIT
#include "engine/scene/exposure_motion.h"

#include "engine/math/transform.h"
#include "engine/scene/camera.h"
#include "engine/scene/lens.h"
#include "engine/scene/path.h"
#include "engine/scene/placing.h"
#include "engine/scene/world.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shutter::scene {

using math::dmat4;
using math::dvec3;

namespace {

double scaleOf(const MotionBlur& blur) {
    return blur.exclude ? 0.0 : blur.scale;
}

/// Times that the picture depends on: the exposure, and what scales reach beyond it.
TimeSpan
findReach(const World& world, const ExposureTimes& exposure, const CameraShutter& shutter) {
    double entityScale = 1.0;
    for (auto [entity, blur] : world.registry.view<MotionBlur>()) {
        (void)entity;
        entityScale = std::max(entityScale, scaleOf(blur));
    }
    const double reach =
        entityScale *
        std::max(
            {1.0, shutter.cameraRotationScale, shutter.cameraTranslationScale, shutter.objectScale}
        );
    // No rounding where nothing is scaled: an event at shutter open is over.
    if (reach == 1.0)
        return {exposure.open, exposure.close};
    const double r = exposure.raster;
    return {r + reach * (exposure.open - r), r + reach * (exposure.close - r)};
}

template <class Event> bool anyHappened(const World& world, const TimeSpan& span) {
    for (auto [entity, event] : world.registry.view<Event>()) {
        (void)entity;
        if (span.contains(event.seconds))
            return true;
    }
    return false;
}

template <class Component> bool hasAny(const World& world) {
    const auto view = world.registry.view<Component>();
    return view.begin() != view.end();
}

bool anyPathCut(const World& world, const TimeSpan& span) {
    for (auto [entity, path] : world.registry.view<PathMotion>()) {
        (void)entity;
        if (hasCutWithin(path, span.after, span.until))
            return true;
    }
    return false;
}

} // namespace

double findBlurScale(const World& world, ecs::Entity entity) {
    const ecs::Entity nearest = findUpwards(world, entity, [&](ecs::Entity at) {
        return findPlacing<MotionBlur>(world.registry, at) != nullptr;
    });
    return nearest == ecs::kNullEntity ? 1.0
                                       : scaleOf(*findPlacing<MotionBlur>(world.registry, nearest));
}

ExposureMotion::ExposureMotion(
    const World& world, ecs::Entity camera, const ExposureInterval& exposure
)
    : mWorld(world), mCamera(camera), mExposure(exposure), mFrame(exposure.frame()),
      mAnyHidden(hasAny<Hidden>(world)) {
    // A still picture has no past to lose.
    if (!(mFrame.open < mFrame.close))
        return;
    mReach = findReach(world, mFrame, exposure.shutter);
    // Times of frames are rounded: an event at the time of the frame before must not fall an ulp
    // behind it and count in this one again.
    const double slack = 4.0 * std::numeric_limits<double>::epsilon() *
                         std::max(std::abs(mFrame.raster), exposure.frameSeconds);
    const double before = mFrame.raster - exposure.frameSeconds;
    mSpan = {std::min(mReach.after, before) + slack, mReach.until};
    mAnyEvents = anyHappened<Appeared>(world, mSpan) || anyHappened<Teleported>(world, mSpan) ||
                 anyPathCut(world, mSpan);
    for (auto [entity, blur] : world.registry.view<MotionBlur>()) {
        (void)entity;
        mAnyBlurScale = mAnyBlurScale || scaleOf(blur) != 1.0;
    }
    mIsCut = scene::isCut(world, camera, mSpan);
    if (!mIsCut)
        findCut();
    if (!mIsCut && exposure.whole)
        noteComings();
}

void ExposureMotion::findCut() {
    if (isHeld(mCamera) || !scene::mayMove(mWorld, mCamera))
        return;
    const auto poseAt = [&](double seconds) {
        return scene::worldFromRigid(mWorld, mCamera, seconds);
    };
    mIsCut = findsCameraCut(poseAt, mReach.after, mReach.until, mExposure.shutter.cuts);
}

void ExposureMotion::noteComings() {
    const TimeSpan frame{mFrame.open, mFrame.close};
    mHasComings = anyHappened<Appeared>(mWorld, frame) || anyHappened<Hidden>(mWorld, frame);
    if (!mHasComings)
        return;
    ExposureInterval whole = mExposure;
    whole.whole.reset();
    whole.open = mFrame.open;
    whole.close = mFrame.close;
    mLastComing = whole.at(invertLight(whole, 1.0 - kMinLight));
}

bool ExposureMotion::isThere(ecs::Entity entity, double seconds) const {
    return findUpwards(mWorld, entity, [&](ecs::Entity at) {
               const auto* appeared = mWorld.registry.find<Appeared>(at);
               const auto* hidden = mWorld.registry.find<Hidden>(at);
               return (hidden && hidden->seconds <= seconds) ||
                      (appeared && appeared->seconds > seconds && appeared->seconds < mLastComing);
           }) == ecs::kNullEntity;
}

bool ExposureMotion::isHidden(ecs::Entity entity) const {
    const bool isPart = mExposure.whole.has_value() && !mIsCut;
    return mAnyHidden && scene::isHidden(mWorld, entity, isPart ? mExposure.open : mFrame.raster);
}

bool ExposureMotion::isHiddenAt(ecs::Entity entity, double s) const {
    return scene::isHidden(mWorld, entity, secondsAt(s));
}

std::vector<double> ExposureMotion::comingsOf(ecs::Entity entity) const {
    std::vector<double> comings;
    if (!mHasComings)
        return comings;
    (void)findUpwards(mWorld, entity, [&](ecs::Entity at) {
        const auto* appeared = mWorld.registry.find<Appeared>(at);
        const auto* hidden = mWorld.registry.find<Hidden>(at);
        const TimeSpan span{mExposure.open, mExposure.close};
        if (appeared && span.contains(appeared->seconds) && appeared->seconds < mLastComing)
            comings.push_back(appeared->seconds);
        if (hidden && span.contains(hidden->seconds))
            comings.push_back(hidden->seconds);
        return false;
    });
    return comings;
}

double ExposureMotion::secondsAt(double s) const {
    // Exact: the raster image equals a still of the same time.
    return s == mExposure.rasterTime ? mExposure.raster : mExposure.at(s);
}

double ExposureMotion::scaleTime(double seconds, double scale) const {
    // Exact: a scale of 1 changes no bit.
    return scale == 1.0 ? seconds : mFrame.raster + scale * (seconds - mFrame.raster);
}

bool ExposureMotion::isHeld(ecs::Entity entity) const {
    return mIsCut || (mAnyEvents && hasNoPast(mWorld, entity, mSpan));
}

bool ExposureMotion::isObjectHeld(ecs::Entity entity) const {
    if (isHeld(entity))
        return true;
    const auto* skinned = mWorld.registry.find<Skinned>(entity);
    return mAnyEvents && skinned &&
           std::any_of(skinned->joints.begin(), skinned->joints.end(), [&](ecs::Entity joint) {
               return isHeld(joint);
           });
}

double ExposureMotion::screenScaleOf(ecs::Entity entity) const {
    return (mAnyBlurScale ? findBlurScale(mWorld, entity) : 1.0) * mExposure.cap.of(entity);
}

double ExposureMotion::speedOf(ecs::Entity entity) const {
    return isObjectHeld(entity) ? 0.0 : screenScaleOf(entity) * mExposure.shutter.objectScale;
}

std::array<double, 2> ExposureMotion::cameraSpeeds() const {
    if (isHeld(mCamera))
        return {0.0, 0.0};
    const CameraShutter& shutter = mExposure.shutter;
    return {
        mExposure.cap.camera * shutter.cameraRotationScale,
        mExposure.cap.camera * shutter.cameraTranslationScale};
}

dmat4 ExposureMotion::cameraAt(double seconds) const {
    if (isHeld(mCamera))
        return scene::worldFromRigid(mWorld, mCamera, mFrame.raster);
    const double turned = scaleTime(seconds, mExposure.shutter.cameraRotationScale);
    const double displaced = scaleTime(seconds, mExposure.shutter.cameraTranslationScale);
    dmat4 world = scene::worldFromRigid(mWorld, mCamera, turned);
    if (displaced != turned)
        world[3] = scene::worldFromRigid(mWorld, mCamera, displaced)[3];
    return world;
}

double ExposureMotion::lensSeconds(double seconds) const {
    return isHeld(mCamera) ? mFrame.raster
                           : scaleTime(seconds, mExposure.shutter.cameraRotationScale);
}

double ExposureMotion::yFovAt(double seconds) const {
    return scene::yFovAt(mWorld, mCamera, lensSeconds(seconds));
}

CameraLens ExposureMotion::cameraLens(double s) const {
    return lensAt(mWorld, mCamera, lensSeconds(scaleTime(secondsAt(s), mExposure.cap.camera)));
}

double ExposureMotion::cameraYFov(double s) const {
    return yFovAt(scaleTime(secondsAt(s), mExposure.cap.camera));
}

bool ExposureMotion::mayCameraZoom() const {
    return mExposure.shutter.cameraRotationScale != 0.0 && mExposure.cap.camera != 0.0 &&
           mayZoom(mWorld, mCamera) && !isHeld(mCamera);
}

dmat4 ExposureMotion::worldFromCamera(double s) const {
    return cameraAt(scaleTime(secondsAt(s), mExposure.cap.camera));
}

bool ExposureMotion::mayCameraMove() const {
    if (mayCameraZoom())
        return true;
    const CameraShutter& shutter = mExposure.shutter;
    return (shutter.cameraRotationScale != 0.0 || shutter.cameraTranslationScale != 0.0) &&
           mExposure.cap.camera != 0.0 && scene::mayMove(mWorld, mCamera) && !isHeld(mCamera);
}

double ExposureMotion::entitySeconds(ecs::Entity entity, double s) const {
    return isHeld(entity) ? mFrame.raster : scaleTime(secondsAt(s), mExposure.shutter.objectScale);
}

dmat4 ExposureMotion::worldFromEntity(ecs::Entity entity, double s) const {
    return scene::worldFromEntity(mWorld, entity, entitySeconds(entity, s));
}

dmat4 ExposureMotion::worldFromLight(ecs::Entity entity, double s) const {
    return scene::worldFromLight(mWorld, entity, entitySeconds(entity, s));
}

double ExposureMotion::objectSeconds(ecs::Entity entity, double seconds, double screenScale) const {
    if (isObjectHeld(entity))
        return mFrame.raster;
    return scaleTime(scaleTime(seconds, screenScale), mExposure.shutter.objectScale);
}

dmat4 ExposureMotion::worldFromObject(ecs::Entity entity, double s) const {
    const double seconds = secondsAt(s);
    if (mHasComings && !isThere(entity, seconds))
        return dmat4(math::dmat3(0.0));
    const double screenScale = screenScaleOf(entity);
    const dmat4 object =
        scene::worldFromObject(mWorld, entity, objectSeconds(entity, seconds, screenScale));
    const double seen = scaleTime(seconds, screenScale);
    const double cameraSeconds = scaleTime(seconds, mExposure.cap.camera);
    if (seen == cameraSeconds || !mayCameraMove())
        return object;
    // On the screen as it would be at `seen`: from there into the view, through the lens of now,
    // and out again.
    dmat4 view = cameraAt(cameraSeconds);
    if (mayCameraZoom()) {
        const double wider = std::tan(yFovAt(cameraSeconds) / 2.0) / std::tan(yFovAt(seen) / 2.0);
        view[0] *= wider;
        view[1] *= wider;
    }
    return view * glm::inverse(cameraAt(seen)) * object;
}

Deformation ExposureMotion::deformationAt(ecs::Entity entity, double s) const {
    return scene::deformationAt(
        mWorld, entity, objectSeconds(entity, secondsAt(s), screenScaleOf(entity))
    );
}

dmat4 ExposureMotion::objectFromBind(ecs::Entity entity, size_t joint, double s) const {
    return scene::objectFromBind(
        mWorld, entity, joint, objectSeconds(entity, secondsAt(s), screenScaleOf(entity))
    );
}

bool ExposureMotion::mayMove(ecs::Entity entity) const {
    return mExposure.shutter.objectScale != 0.0 && scene::mayMove(mWorld, entity) &&
           !isHeld(entity);
}

bool ExposureMotion::mayObjectMove(ecs::Entity entity) const {
    if (mHasComings && !comingsOf(entity).empty())
        return true;
    const double screenScale = screenScaleOf(entity);
    if (screenScale != mExposure.cap.camera && mayCameraMove())
        return true;
    return screenScale != 0.0 && mExposure.shutter.objectScale != 0.0 &&
           scene::mayObjectMove(mWorld, entity) && !isObjectHeld(entity);
}

bool ExposureMotion::mayDeform(ecs::Entity entity) const {
    return screenScaleOf(entity) != 0.0 && mExposure.shutter.objectScale != 0.0 &&
           scene::mayDeform(mWorld, entity) && !isObjectHeld(entity);
}

} // namespace shutter::scene
