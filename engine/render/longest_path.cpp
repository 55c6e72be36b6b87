// SPDX-License-Identifier: MIT
// How far what a picture shows moves, found by looking at it.
#include "engine/extract/exposure_parts.h"
#include "engine/render/renderer.h"

#include <algorithm>
#include <span>
#include <vector>

namespace shutter::render {

core::Result<std::vector<float>>
Renderer::lookAtMotion(const scene::World& world, const extract::ViewRequest& view) {
    FrameRequest look;
    look.view = view;
    look.view.instant.reset();
    look.view.shadows.mode = extract::ShadowMode::None; // only motion counts
    look.isLook = true;
    look.wantColor = false;
    if (!mLongestMotion)
        mLongestMotion.emplace(mDevice);
    PostEffect* const effect = &*mLongestMotion;
    if (const auto seen = renderFrame(world, look, std::span(&effect, 1)); !seen)
        return seen.error();
    return mLongestMotion->take();
}

core::Result<LongestPath>
Renderer::measureLongestPath(const scene::World& world, const extract::ViewRequest& view) {
    LongestPath path;
    if (!(view.exposure.open < view.exposure.close))
        return path;
    auto frame = extract::extractFrame(world, mScene.layout(), view);
    if (!frame)
        return frame.error();
    const extract::MotionParts parts =
        extract::planMotionParts(world, mScene.layout(), frame.value(), view);
    path.px = parts.casterPx;
    path.movesLight = parts.movesLight;
    for (uint32_t i = 0; i < parts.count; ++i) {
        extract::ViewRequest part = view;
        const double length = 1.0 / parts.count;
        part.part = {i * length, (i + 0.5) * length, (i + 1) * length};
        const auto longest = lookAtMotion(world, part);
        if (!longest)
            return longest.error();
        // The fastest part tells how close instants have to be, which are equally far apart.
        for (const float px : longest.value())
            path.px = std::max(path.px, double{px} * parts.count);
    }
    return path;
}

} // namespace shutter::render
