// SPDX-License-Identifier: MIT
#include "modules/motion_blur/plugin/blended_surfaces.h"

#include "engine/core/words.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace shutter::motion_blur {

namespace {

/// Places in the pixel that edges are sampled at, where the picture below is anti-aliased.
constexpr uint32_t kEdgeSamples = 4;

void explain(render::Explainer& explainer, const extract::BlendedLayer& plan) {
    const std::string parts = core::countOf(plan.partCount, "part") + " of the exposure";
    const std::string reason =
        fmt::format("{} in {}, ", core::countOf(plan.instants.size(), "instant"), parts) +
        (plan.readsInstants ? "against the depth that each instant has"
                            : "against the depth of the raster");
    explainer.decide(render::ExplainedKind::Work, "blended instants", {true, reason});
}

} // namespace

void BlendedSurfaces::extract(const render::ExtractContext& context, extract::LayerLimits limits) {
    limits.surfaceBytes = mDevice.limits().maxStorageBufferRange;
    if (context.view.jitterPx != context.colorJitterPx)
        limits.leastInstants = kEdgeSamples;
    extract::ViewRequest view = context.view;
    view.jitterPx = context.colorJitterPx;
    mPlans.at(context.slot) = extract::planBlendedLayer(
        context.world, mScene.layout(), view, context.motion, context.frame, limits
    );
}

std::optional<shader::InstantSurfaces> BlendedSurfaces::wanted(uint32_t slot) const {
    const extract::BlendedLayer& plan = mPlans.at(slot);
    if (plan.empty() || !plan.readsInstants)
        return std::nullopt;
    return plan.surfaces();
}

void BlendedSurfaces::count(uint32_t slot, render::Counters& counters) const {
    const extract::BlendedLayer& plan = mPlans.at(slot);
    if (plan.empty())
        return;
    const shader::InstantSurfaces rectangle = plan.surfaces();
    // Two images of what is drawn and, of several parts, the sum of those before.
    uint64_t perPixel = plan.partCount > 1 ? 24 : 16;
    if (plan.readsInstants)
        perPixel += uint64_t(shader::surfaceWordsPerPixel(rectangle)) * sizeof(uint32_t);
    counters["blended instants"] = rectangle.instantCount;
    counters["blended bytes"] = perPixel * rectangle.sizePx.x * rectangle.sizePx.y;
}

graph::ImageHandle
BlendedSurfaces::declare(const render::PostContext& context, const MotionBlurOutputs& blurred) {
    const extract::BlendedLayer& plan = mPlans.at(context.slot);
    if (plan.empty())
        return blurred.color;
    explain(context.explainer, plan);
    const shader::InstantSurfaces rectangle = plan.surfaces();
    std::vector<float> shares(plan.partCount, 0.0f);
    for (uint32_t i = 0; i < rectangle.instantCount; ++i)
        shares[shader::surfacePartOf(rectangle, i)] += plan.instants[i].weight;
    return mComposite.add(
        context.graph,
        blurred.color,
        [&](uint32_t part) -> BlendedSums {
            const auto [color, opacity] = mLayer.declare(context, plan, blurred.surfaces, part);
            return {color, opacity, shares[part]};
        },
        rectangle,
        blurred.surfaces
    );
}

} // namespace shutter::motion_blur
