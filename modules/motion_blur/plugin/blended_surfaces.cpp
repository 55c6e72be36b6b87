// SPDX-License-Identifier: MIT
#include "modules/motion_blur/plugin/blended_surfaces.h"

#include <utility>
#include <vector>

namespace shutter::motion_blur {

namespace {

/// Places in the pixel that edges are sampled at, where the picture below is anti-aliased.
constexpr uint32_t kEdgeSamples = 4;

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

graph::ImageHandle
BlendedSurfaces::declare(const render::PostContext& context, const MotionBlurOutputs& blurred) {
    const extract::BlendedLayer& plan = mPlans.at(context.slot);
    if (plan.empty())
        return blurred.color;
    const shader::InstantSurfaces rectangle = plan.surfaces();
    std::vector<float> shares(plan.partCount, 0.0f);
    for (uint32_t i = 0; i < rectangle.instantCount; ++i)
        shares[shader::surfacePartOf(rectangle, i)] += plan.instants[i].weight;
    std::vector<BlendedSums> parts;
    for (uint32_t part = 0; part < plan.partCount; ++part) {
        const auto [color, opacity] = mLayer.declare(context, plan, blurred.surfaces, part);
        parts.push_back({color, opacity, shares[part]});
    }
    return mComposite.add(context.graph, blurred.color, parts, rectangle, blurred.surfaces);
}

} // namespace shutter::motion_blur
