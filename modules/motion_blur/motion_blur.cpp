// SPDX-License-Identifier: MIT
#include "modules/motion_blur/motion_blur.h"

#include "spirv/motion_blur/denoise_atrous.comp.h"
#include "spirv/motion_blur/denoise_variance.comp.h"
#include "spirv/motion_blur/guertin2014.comp.h"
#include "spirv/motion_blur/jimenez2014.comp.h"
#include "spirv/motion_blur/mcguire2012.comp.h"
#include "spirv/motion_blur/own_velocity.comp.h"

#include "engine/core/check.h"

#include <array>

namespace shutter::motion_blur {

using shader::MotionBlurParams;

MotionBlur::MotionBlur(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
    : mTileMotion(device), mGather(device),
      mOwnVelocity(device, "own velocity", motion_blur_own_velocity_comp, 2),
      mMcGuire(device, "mcguire2012", motion_blur_mcguire2012_comp, 3), mGuertinTiles(device),
      mGuertin(device, "guertin2014", motion_blur_guertin2014_comp, 4),
      mJimenez(device, "jimenez2014", motion_blur_jimenez2014_comp, 3),
      mVariance(device, "variance of rays", motion_blur_denoise_variance_comp, 3),
      mATrous(device, "denoise", motion_blur_denoise_atrous_comp, 2) {
    if (!sceneLayout || !device.hasRays())
        return;
    if (device.hasRayQuery())
        mStochasticRays = std::make_unique<StochasticRays>(device, sceneLayout);
    mRayMask = std::make_unique<RayMask>(device);
    mRayReveal = std::make_unique<RayReveal>(device, sceneLayout);
}

MotionBlurOutputs MotionBlur::add(
    graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurSettings& settings
) {
    const core::Status valid = validate(settings);
    SHUTTER_CHECK(valid.ok(), "{}", valid.error().message);
    const graph::TransientImageDesc& size = graph.describeImage(inputs.color);
    MotionBlurParams params = resolve(settings, size.width, size.height, inputs.rasterShare);
    params.response = inputs.response;
    switch (settings.method) {
    case Method::Gather:
        return addGather(graph, inputs, params);
    case Method::Hybrid:
        return addHybrid(graph, inputs, params);
    case Method::OwnVelocity:
        return addOwnVelocity(graph, inputs, params);
    case Method::McGuire2012:
        return addTiled(graph, mMcGuire, inputs, params);
    case Method::Guertin2014:
        return addGuertin(graph, inputs, params);
    case Method::Jimenez2014:
        return addTiled(graph, mJimenez, inputs, params);
    case Method::Denoised:
        return addDenoised(graph, inputs, settings, params);
    }
    SHUTTER_CHECK(false, "there is no method {}", static_cast<int>(settings.method));
    return {};
}

MotionBlurOutputs MotionBlur::addGather(
    graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurParams& params
) const {
    MotionBlurOutputs outputs;
    const TileMotionOutputs front = mTileMotion.add(graph, inputs.motionDepth, params, "");
    outputs.tiles = front.tiles;
    outputs.dominant = front.dominant;
    outputs.color =
        mGather.add(graph, {inputs.color, inputs.motionDepth, front.dominant, {}}, params);
    return outputs;
}

MotionBlurOutputs MotionBlur::addHybrid(
    graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurParams& resolved
) {
    SHUTTER_CHECK(inputs.rays && mRayReveal, "the hybrid method needs rays");
    MotionBlurParams params = resolved;
    params.frame = inputs.rays->frame;
    const TileMotionOutputs front = mTileMotion.add(graph, inputs.motionDepth, params, "");
    const RayMaskInputs maskInputs{
        inputs.motionDepth,
        inputs.normal,
        inputs.meshId,
        front.dominant,
        inputs.measureEdgesEverywhere};
    const RayMaskOutputs mask = mRayMask->add(graph, maskInputs, params);
    const RayRevealInputs revealInputs{
        inputs.color, inputs.motionDepth, inputs.meshId, mask.list, mask.arguments, *inputs.rays};
    const RayRevealOutputs reveal = mRayReveal->add(graph, revealInputs, params);
    const TileMotionOutputs behind =
        mTileMotion.add(graph, reveal.motionDepth, params, " of reveal");
    const RevealedLayer layer{reveal.color, reveal.motionDepth, behind.dominant, mask.mask};

    MotionBlurOutputs outputs;
    outputs.tiles = front.tiles;
    outputs.dominant = front.dominant;
    outputs.edge = mask.edge;
    outputs.mask = mask.mask;
    outputs.revealColor = reveal.color;
    outputs.revealMotionDepth = reveal.motionDepth;
    outputs.revealMeshId = reveal.meshId;
    outputs.color =
        mGather.add(graph, {inputs.color, inputs.motionDepth, front.dominant, layer}, params);
    return outputs;
}

MotionBlurOutputs MotionBlur::addOwnVelocity(
    graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurParams& params
) const {
    MotionBlurOutputs outputs;
    outputs.color = mOwnVelocity.add(graph, std::array{inputs.color, inputs.motionDepth}, params);
    return outputs;
}

MotionBlurOutputs MotionBlur::addTiled(
    graph::Graph& graph,
    const ScreenFilter& filter,
    const MotionBlurInputs& inputs,
    const MotionBlurParams& params
) const {
    MotionBlurOutputs outputs;
    const TileMotionOutputs tiles = mTileMotion.add(graph, inputs.motionDepth, params, "");
    outputs.tiles = tiles.tiles;
    outputs.dominant = tiles.dominant;
    outputs.color =
        filter.add(graph, std::array{inputs.color, inputs.motionDepth, tiles.dominant}, params);
    return outputs;
}

MotionBlurOutputs MotionBlur::addGuertin(
    graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurParams& params
) const {
    MotionBlurOutputs outputs;
    outputs.tiles = mTileMotion.addTileMax(graph, inputs.motionDepth, params, "");
    const GuertinTilesOutputs tiles = mGuertinTiles.add(graph, outputs.tiles, params);
    outputs.dominant = tiles.dominant;
    outputs.variance = tiles.variance;
    outputs.color = mGuertin.add(
        graph, std::array{inputs.color, inputs.motionDepth, tiles.dominant, tiles.variance}, params
    );
    return outputs;
}

MotionBlurOutputs MotionBlur::addDenoised(
    graph::Graph& graph,
    const MotionBlurInputs& inputs,
    const MotionBlurSettings& settings,
    const MotionBlurParams& resolved
) const {
    SHUTTER_CHECK(
        inputs.movingRays && mStochasticRays,
        "the denoised method needs moving rays, by ray queries"
    );
    MotionBlurParams params = resolved;
    params.frame = inputs.movingRays->frame;
    params.moving = inputs.movingRays->moving;
    const StochasticRaysOutputs rays = mStochasticRays->add(graph, *inputs.movingRays, params);
    const TileMotionOutputs tiles = mTileMotion.add(graph, rays.motionDepth, params, "");
    MotionBlurOutputs outputs;
    outputs.noisy = rays.color;
    outputs.tiles = tiles.tiles;
    outputs.dominant = tiles.dominant;
    outputs.color =
        mVariance.add(graph, std::array{rays.color, rays.motionDepth, tiles.dominant}, params);
    for (uint32_t level = 0; level < settings.filterLevels; ++level) {
        params.stepPx = static_cast<float>(1u << level);
        outputs.color = mATrous.add(
            graph,
            std::array{outputs.color, tiles.dominant},
            params,
            fmt::format(", step {}", 1u << level)
        );
    }
    return outputs;
}

MotionBlurCounters MotionBlur::counters() const {
    if (!mRayReveal)
        return {};
    const shader::MaskHeader header = mRayReveal->lastHeader();
    return {header.maskedPixels, header.raysTraced};
}

} // namespace shutter::motion_blur
