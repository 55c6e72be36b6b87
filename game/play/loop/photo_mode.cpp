// SPDX-License-Identifier: MIT
#include "game/play/loop/photo_mode.h"

#include "engine/core/setting_row.h"
#include "engine/scene/motion.h"
#include "engine/scene/shutter.h"

namespace shutter::game {

void PhotoMode::turn(bool on, bool traces) {
    mIsOn = on;
    mTraces = traces;
    mRays = 0;
    mPicture.reset();
}

PlaySettings PhotoMode::choose(const PlaySettings& settings) const {
    PlaySettings chosen = settings;
    if (mTraces)
        chosen.method = "truth";
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
           core::areEqual(extract::listShadowRows(), a.view.shadows, b.view.shadows) &&
           first.open == second.open && first.raster == second.raster &&
           first.close == second.close &&
           core::areEqual(scene::listShutterRows(), first.shutter, second.shutter) &&
           core::areEqual(
               scene::listResponseRows(), first.shutter.response, second.shutter.response
           ) &&
           first.shutter.response.samples == second.shutter.response.samples &&
           a.cameraAtOpen == b.cameraAtOpen && a.cameraAtClose == b.cameraAtClose;
}

uint32_t PhotoMode::begin(const scene::World& world, const extract::ViewRequest& view) {
    Picture picture{
        view,
        scene::worldFromEntity(world, view.camera, view.exposure.open),
        scene::worldFromEntity(world, view.camera, view.exposure.close)};
    if (!mPicture || !areSame(*mPicture, picture))
        mRays = 0;
    mPicture = std::move(picture);
    return mRays;
}

std::optional<uint32_t> PhotoMode::rays() const {
    return isTracing() ? std::optional(mRays) : std::nullopt;
}

} // namespace shutter::game
