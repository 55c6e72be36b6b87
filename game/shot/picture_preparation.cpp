// SPDX-License-Identifier: MIT
// Computes properties of a picture before its frames are drawn: motion cap, number of instants,
// parts of the exposure.
#include "engine/core/check.h"
#include "engine/core/log.h"
#include "game/shot/picture_drawer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace shutter::game {

namespace {

core::Status
checkSize(const gpu::Device& device, const MethodInfo& method, uint32_t width, uint32_t height) {
    const uint32_t longest = device.limits().maxImageDimension2D;
    if (width > longest || height > longest)
        return core::makeError(
            "--size {}x{}: {} draws at most {} pixels a side",
            width,
            height,
            device.info().name,
            longest
        );
    const uint64_t bytesPerPixel = method.blur ? method.blur->listBytesPerPixel : 0;
    const uint64_t listBytes = uint64_t(width) * height * bytesPerPixel + 16;
    if (listBytes > device.limits().maxStorageBufferRange)
        return core::makeError(
            "--size {}x{}: method {} needs a buffer of {} MiB, {} has at most {}",
            width,
            height,
            method.name,
            listBytes >> 20,
            device.info().name,
            device.limits().maxStorageBufferRange >> 20
        );
    return {};
}

/// "; --device 'llvmpipe' can", or nothing if no other device of the machine can.
std::string suggestDevice(const gpu::Device& device, const MethodInfo& method) {
    std::vector<gpu::DeviceInfo> others = gpu::listDevices(device.instance());
    std::erase_if(others, [&](const gpu::DeviceInfo& other) {
        return other.handle == device.physical();
    });
    const gpu::DeviceInfo* found = findDeviceFor(method, others);
    return found ? fmt::format("; --device '{}' can", found->name) : std::string();
}

core::Status checkRays(const gpu::Device& device, const MethodInfo& method) {
    if (canRun(method, device))
        return {};
    const std::string other = suggestDevice(device, method);
    if (device.hasRays())
        return core::makeError(
            "--method {} nests ray queries (VK_KHR_ray_query), which {} lacks or --rays hides{}; "
            "resolved, hybrid and accumulate do without",
            method.name,
            device.info().name,
            other
        );
    return core::makeError(
        "--method {} needs ray tracing (VK_KHR_ray_query or, for hybrid, "
        "VK_KHR_ray_tracing_pipeline), which {} lacks or --rays hides{}; resolved and gather do "
        "without",
        method.name,
        device.info().name,
        other
    );
}

} // namespace

InstantChoice chooseInstants(const render::LongestPath& path, double maxStepPx, uint32_t most) {
    InstantChoice choice;
    // Compared as numbers: a way may be longer than any integer.
    const double wanted = std::max(
        std::ceil(path.px / maxStepPx),
        path.movesLight || path.hasFleeting ? double{kMinInstantsOfLight} : 1.0
    );
    choice.count = wanted < most ? static_cast<uint32_t>(wanted) : most;
    choice.stepPx = path.px / choice.count;
    if (path.px > 0.0)
        choice.reason = fmt::format(
            "the longest way is {:.1f} px, {:.2f} px from one to the next", path.px, choice.stepPx
        );
    else
        choice.reason = path.movesLight ? "only light moves"
                        : path.hasFleeting
                            ? "nothing moves, but something comes, goes or changes its colour"
                            : "nothing moves";
    return choice;
}

core::Result<PictureRequest>
PictureDrawer::prepare(const scene::World& world, const PictureRequest& request) {
    SHUTTER_CHECK(request.slot < kSlots, "slot {} of {}", request.slot, kSlots);
    const extract::ViewRequest& view = request.frame.view;
    SHUTTER_TRY(check(mDevice, request.method, view.width, view.height));
    if (countSteps(request.method) + request.raysBefore == 0)
        return core::makeError("--samples 0: {} needs at least one", request.method.method->name);
    mFeatures.configure(request.features);
    PictureRequest prepared = request;
    prepared.frame.view.unseenMatters = unseenMatters(request.features);
    if (!prepared.cap) {
        auto cap = measureCap(world, prepared.frame.view);
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

core::Result<InstantChoice>
PictureDrawer::findInstants(const scene::World& world, const PictureRequest& request) {
    finishUntil(0); // measuring draws additional frames
    mFeatures.configure(request.features);
    const auto path =
        mMeasures.measureLongestPath(world, request.frame.view, mFeatures.listWith({}).overlays);
    if (!path)
        return path.error();
    return chooseInstants(path.value(), *request.method.maxStepPx, request.method.samples);
}

core::Status PictureDrawer::prepareInstants(const scene::World& world, PictureRequest& request) {
    SHUTTER_CHECK(!request.frame.view.usesLens, "a step by motion knows nothing of a lens");
    if (!request.instants) {
        auto found = findInstants(world, request);
        if (!found)
            return found.error();
        request.instants = std::move(found).value();
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
    extract::ViewRequest capped = view;
    if (std::isfinite(view.exposure.shutter.maxBlurPercent)) {
        finishUntil(0); // measuring draws additional frames
        // Jumps have no motion between their places.
        const auto parts = extract::planExposureParts(world, mRenderer.scene().layout(), view);
        if (!parts.empty())
            capped.exposure = parts.back().exposure;
    }
    return mMeasures.measureCap(world, capped);
}

core::Status PictureDrawer::check(
    const gpu::Device& device, const MethodOptions& method, uint32_t width, uint32_t height
) {
    SHUTTER_TRY(checkRays(device, *method.method));
    return checkSize(device, *method.method, width, height);
}

} // namespace shutter::game
