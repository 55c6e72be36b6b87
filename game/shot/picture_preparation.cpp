// SPDX-License-Identifier: MIT
// What has to be known of a picture before its frames can be drawn: what its shutter caps, how many
// instants it takes, and in what parts.
#include "engine/core/check.h"
#include "engine/core/log.h"
#include "game/shot/picture_drawer.h"

#include <cmath>
#include <utility>

namespace shutter::game {

core::Result<PictureRequest>
PictureDrawer::prepare(const scene::World& world, const PictureRequest& request) {
    SHUTTER_CHECK(request.slot < kSlots, "slot {} of {}", request.slot, kSlots);
    const extract::ViewRequest& view = request.frame.view;
    SHUTTER_TRY(check(mDevice, request.method, view.width, view.height));
    if (countSteps(request.method) + request.raysBefore == 0)
        return core::makeError("--samples 0: {} needs at least one", request.method.method->name);
    PictureRequest prepared = request;
    if (!prepared.cap) {
        auto cap = measureCap(world, view);
        if (!cap)
            return cap.error();
        prepared.cap = std::move(cap).value();
    }
    prepared.frame.view.exposure.cap = *prepared.cap;
    if (prepared.method.maxStepPx)
        SHUTTER_TRY(prepareInstants(world, prepared));
    prepared.exposureParts = planExposure(world, prepared.method, prepared.frame.view);
    return prepared;
}

std::vector<extract::ExposurePart> PictureDrawer::planExposure(
    const scene::World& world, const MethodOptions& method, const extract::ViewRequest& view
) const {
    // The other families take each instant by itself, or one.
    if (method.method->family != MethodFamily::MotionBlur)
        return {};
    return extract::planExposureParts(world, mRenderer.scene().layout(), view);
}

core::Status PictureDrawer::prepareInstants(const scene::World& world, PictureRequest& request) {
    if (!request.instants) {
        finishUntil(0); // measuring draws frames of its own
        const auto path = mRenderer.measureLongestPath(world, request.frame.view);
        if (!path)
            return path.error();
        request.instants =
            chooseInstants(path.value(), *request.method.maxStepPx, request.method.samples);
        if (request.instants->stepPx > *request.method.maxStepPx * (1.0 + 1.0e-9))
            core::logWarning(
                "frame at {} s: {} instants are {:.2f} px apart, not {} (--samples allows more)",
                request.frame.view.exposure.raster,
                request.instants->count,
                request.instants->stepPx,
                *request.method.maxStepPx
            );
    }
    request.method.samples = request.instants->count;
    request.method.maxStepPx.reset();
    return {};
}

core::Result<scene::MotionCap>
PictureDrawer::measureCap(const scene::World& world, const extract::ViewRequest& view) {
    extract::ViewRequest look = view;
    if (std::isfinite(view.exposure.shutter.maxBlurPercent)) {
        finishUntil(0); // measuring draws frames of its own
        // What jumps goes no way from one place to the other.
        const auto parts = extract::planExposureParts(world, mRenderer.scene().layout(), view);
        if (!parts.empty())
            look.exposure = parts.back().exposure;
    }
    return mRenderer.measureMotionCap(world, look);
}

} // namespace shutter::game
