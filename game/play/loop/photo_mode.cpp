// SPDX-License-Identifier: MIT
#include "game/play/loop/photo_mode.h"

#include "engine/core/check.h"
#include "engine/core/setting_row.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/camera.h"
#include "engine/scene/history.h"
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"
#include "engine/scene/shutter.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <utility>

namespace shutter::game {

namespace {

constexpr double kMetresPerSecond = 4.0; ///< until changed by the wheel

math::Transform toTransform(const math::dmat4& rigid) {
    math::Transform transform;
    transform.translation = math::dvec3(rigid[3]);
    transform.rotation = glm::normalize(glm::quat_cast(math::dmat3(rigid)));
    return transform;
}

/// Up to rounding.
bool isNear(const math::dmat4& a, const math::dmat4& b) {
    for (int column = 0; column < 3; ++column)
        if (!(glm::distance(a[column], b[column]) < 1.0e-9))
            return false;
    return true;
}

template <class Component>
void copyComponent(scene::World& world, ecs::Entity from, ecs::Entity to) {
    if (const auto* found = std::as_const(world.registry).find<Component>(from)) {
        Component copied = *found;
        world.registry.add(to, std::move(copied));
    }
}

/// With what zooms and focuses it, so that an exposure shows that, too, and what the viewer
/// changes.
void copyLens(scene::World& world, ecs::Entity from, ecs::Entity to) {
    copyComponent<scene::LensMotion>(world, from, to);
    copyComponent<scene::CameraLens>(world, from, to);
    copyComponent<scene::FocusMotion>(world, from, to);
    copyComponent<scene::AutoFocus>(world, from, to);
    copyComponent<scene::FocusTrail>(world, from, to);
    copyComponent<scene::LensOverride>(world, from, to);
}

bool isSameView(const app::FlyView& a, const app::FlyView& b) {
    return a.position == b.position && a.yaw == b.yaw && a.pitch == b.pitch;
}

} // namespace

void PhotoMode::turn(bool on, bool traces) {
    mIsOn = on;
    mTraces = traces;
    mRays = 0;
    mPicture.reset();
}

PlaySettings PhotoMode::choose(const PlaySettings& settings, bool hasLens) const {
    PlaySettings chosen = settings;
    if (mTraces) {
        chosen.method = "truth";
    } else if (hasLens) {
        chosen.method = "accumulate";
        chosen.instants = std::max(chosen.instants, kLensPictures);
    }
    chosen.split = false;
    chosen.view.clear();
    return chosen;
}

bool PhotoMode::areSame(const Picture& a, const Picture& b) {
    const scene::ExposureInterval& first = a.view.exposure;
    const scene::ExposureInterval& second = b.view.exposure;
    return a.view.camera == b.view.camera && a.view.width == b.view.width &&
           a.view.height == b.view.height && a.view.background == b.view.background &&
           a.view.ambient == b.view.ambient && a.view.environment == b.view.environment &&
           areEqual(a.features, b.features) && first.open == second.open &&
           first.raster == second.raster && first.close == second.close &&
           core::areEqual(scene::listShutterRows(), first.shutter, second.shutter) &&
           core::areEqual(
               scene::listResponseRows(), first.shutter.response, second.shutter.response
           ) &&
           first.shutter.response.samples == second.shutter.response.samples &&
           a.cameraAtOpen == b.cameraAtOpen && a.cameraAtClose == b.cameraAtClose &&
           core::areEqual(scene::listLensRows(), a.lensAtOpen, b.lensAtOpen) &&
           core::areEqual(scene::listLensRows(), a.lensAtClose, b.lensAtClose);
}

uint32_t PhotoMode::begin(
    const scene::World& world, const extract::ViewRequest& view, const FeatureSettings& features
) {
    Picture picture{
        view,
        features,
        scene::worldFromEntity(world, view.camera, view.exposure.open),
        scene::worldFromEntity(world, view.camera, view.exposure.close),
        scene::lensAt(world, view.camera, view.exposure.open),
        scene::lensAt(world, view.camera, view.exposure.close)};
    if (!mPicture || !areSame(*mPicture, picture))
        mRays = 0;
    mPicture = std::move(picture);
    return mRays;
}

std::optional<uint32_t> PhotoMode::rays() const {
    return isTracing() ? std::optional(mRays) : std::nullopt;
}

void PhotoCamera::take(scene::World& world, ecs::Entity stageCamera, double seconds) {
    if (mOut)
        return;
    const math::dmat4 worldFromStage = worldFromEntity(world, stageCamera, seconds);
    const math::dmat4 worldFromView = worldFromRigid(world, stageCamera, seconds);
    const scene::Camera camera = world.registry.get<scene::Camera>(stageCamera);
    Out out;
    out.entity = world.registry.create();
    world.registry.add(out.entity, camera);
    copyLens(world, stageCamera, out.entity);
    // Removes the stage's scale and mirroring; a stage scaled to zero has no passengers.
    const math::dmat4 stageFromWorld = glm::inverse(worldFromStage);
    const bool carries = math::isFinite(stageFromWorld);
    if (carries)
        world.registry.add(out.entity, scene::Parent{stageCamera});
    out.stageFromWorld = carries ? stageFromWorld : math::dmat4(1.0);
    out.rest = carries && isNear(worldFromStage, worldFromView)
                   ? math::dmat4(1.0)
                   : out.stageFromWorld * worldFromView;
    world.registry.add(out.entity, scene::LocalMatrix{out.rest});
    out.start = app::makeFly(toTransform(worldFromView), kMetresPerSecond);
    out.view = out.start;
    mOut = out;
}

void PhotoCamera::putBack(scene::World& world) {
    if (mOut)
        scene::despawn(world, mOut->entity);
    mOut.reset();
}

ecs::Entity PhotoCamera::entity() const {
    SHUTTER_CHECK(mOut, "the photo camera is not out");
    return mOut->entity;
}

void PhotoCamera::advance(
    scene::World& world, const app::InputState& input, double wallSeconds, double heightPx
) {
    if (!mOut)
        return;
    steer(mOut->view, input, wallSeconds, heightPx);
    // A view has no roll: an unmoved view is the stage's camera itself.
    math::dmat4 local = mOut->rest;
    if (!isSameView(mOut->view, mOut->start))
        local = mOut->stageFromWorld * computeMatrix(placementOf(mOut->view));
    world.registry.get<scene::LocalMatrix>(mOut->entity).matrix = local;
}

} // namespace shutter::game
