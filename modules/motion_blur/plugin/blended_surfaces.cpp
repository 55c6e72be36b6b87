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

void explain(
    render::Explainer& explainer,
    const char* name,
    const shader::InstantSurfaces& instants,
    bool areLookedUp
) {
    const std::string parts = core::countOf(instants.partCount, "part") + " of the exposure";
    const std::string reason =
        fmt::format("{} in {}, ", core::countOf(instants.instantCount, "instant"), parts) +
        (areLookedUp ? "against the depth that each instant has" : "against the depth of the raster"
        );
    explainer.decide(render::ExplainedKind::Work, name, {true, reason});
}

uint64_t countSurfaceBytes(const shader::InstantSurfaces& instants) {
    const glm::uvec2 allocated = shader::sizeInSteps(instants.sizePx);
    return uint64_t(shader::surfaceWordsPerPixel(instants)) * sizeof(uint32_t) * allocated.x *
           allocated.y;
}

} // namespace

bool BlendedSurfaces::Plan::sharesSurfaces() const {
    if (!layerReadsInstants() || !particles)
        return false;
    const glm::uvec2 end = particles->originPx + particles->sizePx;
    return glm::all(glm::lessThanEqual(layer.originPx, particles->originPx)) &&
           glm::all(glm::lessThanEqual(end, layer.originPx + layer.sizePx)) &&
           particles->instantCount <= layer.instants.size();
}

void BlendedSurfaces::extract(const render::ExtractContext& context, extract::LayerLimits limits) {
    limits.surfaceBytes = mDevice.limits().maxStorageBufferRange;
    Plan& plan = mPlans.at(context.slot);
    plan.particles.reset();
    if (context.particles)
        plan.particles = extract::planParticleInstants(
            {context.world, mScene.layout(), context.view, context.motion, context.frame},
            *context.particles,
            limits
        );
    if (context.view.jitterPx != context.colorJitterPx)
        limits.leastInstants = kEdgeSamples;
    extract::ViewRequest view = context.view;
    view.jitterPx = context.colorJitterPx;
    plan.layer = extract::planBlendedLayer(
        context.world,
        mScene.layout(),
        view,
        context.motion,
        context.frame,
        context.takenRows,
        limits
    );
    // Over the layer there is one background: that of its parts is seen through the layer.
    if (plan.particles && !plan.layer.empty())
        plan.particles->partCount = 1;
    if (plan.sharesSurfaces())
        plan.particles->instantCount = plan.layer.surfaces().instantCount;
}

std::vector<shader::InstantSurfaces> BlendedSurfaces::wanted(uint32_t slot) const {
    const Plan& plan = mPlans.at(slot);
    std::vector<shader::InstantSurfaces> all;
    if (plan.layerReadsInstants())
        all.push_back(plan.layer.surfaces());
    if (plan.particles && !plan.sharesSurfaces())
        all.push_back(*plan.particles);
    return all;
}

void BlendedSurfaces::count(uint32_t slot, render::Counters& counters) const {
    const Plan& plan = mPlans.at(slot);
    if (plan.particles)
        counters["particle instants"] = plan.particles->instantCount;
    if (plan.particles && !plan.sharesSurfaces())
        counters["particle bytes"] = countSurfaceBytes(*plan.particles);
    if (plan.layer.empty())
        return;
    const shader::InstantSurfaces rectangle = plan.layer.surfaces();
    // Two images of the drawn part and, with several parts, the sum of the earlier ones.
    const uint64_t perPixel = plan.layer.partCount > 1 ? 24 : 16;
    counters["blended instants"] = rectangle.instantCount;
    const glm::uvec2 allocated = shader::sizeInSteps(rectangle.sizePx);
    counters["blended bytes"] = perPixel * allocated.x * allocated.y +
                                (plan.layer.readsInstants ? countSurfaceBytes(rectangle) : 0);
}

graph::ImageHandle
BlendedSurfaces::declare(render::PictureContext& context, const MotionBlurOutputs& blurred) {
    const Plan& plan = mPlans.at(context.slot);
    context.particleInstants.reset();
    if (plan.particles && !blurred.surfaces.empty()) {
        context.particleInstants = {*plan.particles, blurred.surfaces.back()};
        explain(context.explainer, "particle instants", *plan.particles, true);
    }
    if (plan.layer.empty())
        return blurred.color;
    explain(context.explainer, "blended instants", plan.layer.surfaces(), plan.layer.readsInstants);
    return declareLayer(
        context,
        plan.layer,
        blurred.color,
        plan.layer.readsInstants ? blurred.surfaces.front() : graph::BufferHandle{}
    );
}

graph::ImageHandle BlendedSurfaces::declareLayer(
    const render::PictureContext& context,
    const extract::BlendedLayer& layer,
    graph::ImageHandle blurred,
    graph::BufferHandle surfaces
) {
    const shader::InstantSurfaces rectangle = layer.surfaces();
    std::vector<float> shares(layer.partCount, 0.0f);
    for (uint32_t i = 0; i < rectangle.instantCount; ++i)
        shares[shader::surfacePartOf(rectangle, i)] += layer.instants[i].weight;
    return mComposite.add(
        context.graph,
        blurred,
        [&](uint32_t part) -> BlendedSums {
            const auto [color, opacity] = mLayer.declare(context, layer, surfaces, part);
            return {color, opacity, shares[part]};
        },
        rectangle,
        surfaces
    );
}

} // namespace shutter::motion_blur
