// SPDX-License-Identifier: MIT
#include "engine/render/motion_measures.h"

#include "engine/extract/exposure_parts.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/shutter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace shutter::render {

namespace {

constexpr double kTolerance = 0.01;

/// \return whether `length` is beyond the cap; then `share` is lowered
bool tighten(double& share, double length, double maxPx) {
    if (!(length > maxPx * (1.0 + kTolerance)))
        return false;
    share *= maxPx / length;
    return true;
}

/// Lowers the shares of entities that move farther than the cap.
/// \param frame extracted with `cap`
/// \param longest motion of each row's pixels; the last is the sky's
/// \param uncapped motion of the same exposure without a cap: separates movers from the static
/// world
/// \param maxPx the cap, 0 or more
/// \return true: something moved farther than the cap, by more than a hundredth
bool tightenCap(
    scene::MotionCap& cap,
    const extract::ExtractedFrame& frame,
    const std::vector<float>& longest,
    const scene::ExposureMotion& uncapped,
    double maxPx
) {
    const size_t rows = frame.entities.size();
    double still = double{longest[rows]};
    bool isTightened = false;
    std::vector<std::pair<ecs::Entity, double>> movers;
    for (size_t row = 0; row < rows; ++row) {
        const ecs::Entity entity = frame.entityHandles[row];
        if (!uncapped.mayObjectMove(entity) && !uncapped.mayDeform(entity)) {
            still = std::max(still, double{longest[row]});
            continue;
        }
        const double* before = cap.findMover(entity);
        double share = before ? *before : 1.0;
        isTightened = tighten(share, double{longest[row]}, maxPx) || isTightened;
        movers.emplace_back(entity, share);
    }
    std::sort(movers.begin(), movers.end(), [](const auto& a, const auto& b) {
        return a.first.index < b.first.index;
    });
    cap.movers = std::move(movers);
    return tighten(cap.camera, still, maxPx) || isTightened;
}

} // namespace

core::Result<std::vector<float>>
MotionMeasures::drawMotion(const scene::World& world, const extract::ViewRequest& view) {
    FrameRequest request;
    request.view = view;
    request.view.instant.reset();
    request.measuresMotion = true;
    request.wantColor = false;
    if (!mLongestMotion)
        mLongestMotion.emplace(mDevice);
    Effect* const effect = &*mLongestMotion;
    if (const auto seen = mRenderer.renderFrame(world, request, {.effects = std::span(&effect, 1)});
        !seen)
        return seen.error();
    return mLongestMotion->take();
}

core::Result<LongestPath> MotionMeasures::measureLongestPath(
    const scene::World& world,
    const extract::ViewRequest& view,
    std::span<const Overlay* const> overlays
) {
    LongestPath path;
    if (!(view.exposure.open < view.exposure.close))
        return path;
    auto frame = extract::extractFrame(world, mRenderer.scene().layout(), view);
    if (!frame)
        return frame.error();
    const extract::MotionParts parts =
        extract::planMotionParts(world, mRenderer.scene().layout(), frame.value(), view);
    path.px = parts.unseenPx;
    path.movesLight = parts.movesLight;
    for (uint32_t i = 0; i < parts.count; ++i) {
        extract::ViewRequest part = view;
        const double length = 1.0 / parts.count;
        part.part = {i * length, (i + 0.5) * length, (i + 1) * length};
        const auto longest = drawMotion(world, part);
        if (!longest)
            return longest.error();
        // The fastest part determines the spacing of the instants, which is uniform.
        for (const float px : longest.value())
            path.px = std::max(path.px, double{px} * parts.count);
    }
    for (const Overlay* overlay : overlays) {
        const auto motion = overlay->measureMotion(world, view);
        if (!motion)
            return motion.error();
        path.px = std::max(path.px, motion.value().longestPx);
        path.hasFleeting = path.hasFleeting || motion.value().isFleeting;
    }
    return path;
}

core::Result<scene::MotionCap>
MotionMeasures::measureCap(const scene::World& world, const extract::ViewRequest& view) {
    // A rotating mover's chord is not proportional to its angle: further iterations find the rest.
    constexpr int kMaxIterations = 4;
    const double percent = view.exposure.shutter.maxBlurPercent;
    scene::MotionCap cap;
    if (!std::isfinite(percent) || !(view.exposure.open < view.exposure.close))
        return cap;
    extract::ViewRequest request = view;
    const double maxPx = std::max(percent, 0.0) / 100.0 * view.width;
    std::optional<scene::ExposureMotion> uncapped; // made once the world was found to be valid
    for (int i = 0; i < kMaxIterations; ++i) {
        request.exposure.cap = cap;
        auto frame = extract::extractFrame(world, mRenderer.scene().layout(), request);
        if (!frame)
            return frame.error();
        if (!uncapped)
            uncapped.emplace(world, view.camera, request.exposure);
        const auto longest = drawMotion(world, request);
        if (!longest)
            return longest.error();
        if (!tightenCap(cap, frame.value(), longest.value(), *uncapped, maxPx))
            break;
    }
    return cap;
}

} // namespace shutter::render
