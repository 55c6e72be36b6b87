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
    : mTileMotion(device), mSorter(device), mStillPixels(device), mCostView(device),
      mGather(device),
      mOwnVelocity(device, "own velocity", motion_blur_own_velocity_comp, 2, shader::kMixedList),
      mMcGuire(device, "mcguire2012", motion_blur_mcguire2012_comp, 3, shader::kMixedList),
      mGuertinTiles(device),
      mGuertin(device, "guertin2014", motion_blur_guertin2014_comp, 4, shader::kMixedList),
      mJimenez(device, "jimenez2014", motion_blur_jimenez2014_comp, 3, shader::kMixedList),
      mVariance(device, "variance of rays", motion_blur_denoise_variance_comp, 3),
      mATrous(device, "denoise", motion_blur_denoise_atrous_comp, 2) {
    if (!sceneLayout || !device.hasRays())
        return;
    if (device.hasRayQuery())
        mStochasticRays = std::make_unique<StochasticRays>(device, sceneLayout);
    mRayMask = std::make_unique<RayMask>(device);
    mRayReveal = std::make_unique<RayReveal>(device, sceneLayout);
    mRevealedLayer = std::make_unique<RevealedLayerPasses>(device);
}

void MotionBlur::chooseStillPixelsBy(const MotionBlurInputs& inputs) {
    if (inputs.target.isValid()) {
        mStillPixelsBy =
            inputs.target == inputs.color ? StillPixelsBy::CopyBack : StillPixelsBy::WholeCopy;
        return;
    }
    // The share of the slot's last frame is a good guess at this one's; the picture is the same
    // either way.
    const BlockCounters last = mSorter.counters(inputs.slot);
    const uint32_t moving = last.uniform + last.mixed + last.masked;
    const uint32_t all = moving + last.still;
    if (!inputs.colorIsWritable || all == 0)
        mStillPixelsBy = StillPixelsBy::WholeCopy;
    else
        mStillPixelsBy = chooseStillPixels(double(moving) / double(all), mStillPixelsBy);
}

MotionBlurOutputs MotionBlur::add(
    graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurSettings& settings
) {
    const core::Status valid = validate(settings);
    SHUTTER_CHECK(valid.ok(), "{}", valid.error().message);
    const graph::TransientImageDesc& size = graph.describeImage(inputs.color);
    MotionBlurParams params = resolve(settings, size.width, size.height, inputs.rasterTime);
    params.response = inputs.response;
    chooseStillPixelsBy(inputs);
    switch (settings.method) {
    case Method::Gather:
        return addGather(graph, inputs, params);
    case Method::Hybrid:
        return addHybrid(graph, inputs, params);
    case Method::OwnVelocity:
    case Method::McGuire2012:
    case Method::Guertin2014:
    case Method::Jimenez2014:
        return addRival(graph, settings.method, inputs, params);
    case Method::Denoised:
        return addDenoised(graph, inputs, settings, params);
    }
    SHUTTER_CHECK(false, "there is no method {}", static_cast<int>(settings.method));
    return {};
}

MotionBlurOutputs MotionBlur::addGather(
    graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurParams& params
) {
    const TileMotionOutputs tiles = mTileMotion.add(graph, inputs.motionDepth, params);
    const SortedBlocks blocks = mSorter.add(graph, tiles, params, false);
    mSorter.addCounters(graph, blocks, params, inputs.slot);
    const graph::ImageHandle target =
        mStillPixels.begin(graph, inputs.color, inputs.target, mStillPixelsBy);
    const graph::ImageHandle filtered = mGather.add(
        graph, {inputs.color, inputs.motionDepth, tiles.dominant, {}}, blocks, target, params
    );

    MotionBlurOutputs outputs;
    outputs.tiles = tiles.tiles;
    outputs.dominant = tiles.dominant;
    outputs.blocks = blocks;
    outputs.cost = mCostView.add(graph, inputs.motionDepth, {}, blocks, params);
    outputs.color =
        mStillPixels.end(graph, inputs.color, filtered, blocks, false, params, mStillPixelsBy);
    return outputs;
}

MotionBlurOutputs MotionBlur::addHybrid(
    graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurParams& resolved
) {
    SHUTTER_CHECK(inputs.rays && mRayReveal, "the hybrid method needs rays");
    MotionBlurParams params = resolved;
    params.frame = inputs.rays->frame;
    const TileMotionOutputs tiles = mTileMotion.add(graph, inputs.motionDepth, params);
    const SortedBlocks sorted = mSorter.add(graph, tiles, params, true);
    const RayMaskInputs maskInputs{
        inputs.motionDepth, inputs.normal, inputs.entityId, sorted, inputs.measureEdgesEverywhere};
    const RayMaskOutputs mask = mRayMask->add(graph, maskInputs, params);
    mSorter.addCounters(graph, mask.blocks, params, inputs.slot);
    const RayRevealInputs revealInputs{

        inputs.color,
        inputs.motionDepth,
        inputs.entityId,
        mask.mask,
        mask.list,
        mask.arguments,
        *inputs.rays,
        inputs.slot};
    const RayRevealOutputs reveal = mRayReveal->add(graph, revealInputs, params);
    const RevealedLayerInputs layerInputs{
        inputs.color, inputs.motionDepth, tiles.tiles, mask, reveal};
    const RevealedLayer layer{
        reveal.color,
        reveal.motionDepth,
        mRevealedLayer->addDominant(graph, layerInputs, params),
        mask.mask};
    const RevealedViews views = mRevealedLayer->addViews(graph, layerInputs, params);
    const graph::ImageHandle target =
        mStillPixels.begin(graph, inputs.color, inputs.target, mStillPixelsBy);
    const graph::ImageHandle filtered = mGather.add(
        graph,
        {inputs.color, inputs.motionDepth, tiles.dominant, layer},
        mask.blocks,
        target,
        params
    );

    MotionBlurOutputs outputs;
    outputs.tiles = tiles.tiles;
    outputs.dominant = tiles.dominant;
    outputs.edge = mask.edge;
    outputs.mask = mask.mask;
    outputs.revealColor = views.color;
    outputs.revealMotionDepth = views.motionDepth;
    outputs.revealEntityId = reveal.entityId;
    outputs.blocks = mask.blocks;
    outputs.cost = mCostView.add(graph, inputs.motionDepth, mask.mask, mask.blocks, params);
    outputs.color =
        mStillPixels.end(graph, inputs.color, filtered, mask.blocks, true, params, mStillPixelsBy);
    return outputs;
}

MotionBlurOutputs MotionBlur::addRival(
    graph::Graph& graph,
    Method method,
    const MotionBlurInputs& inputs,
    const MotionBlurParams& resolved
) {
    MotionBlurParams params = resolved;
    // A pixel's own motion is all that own velocity reads: no neighbour's comes over it.
    if (method == Method::OwnVelocity)
        params.neighbourRadius = 0;
    const TileMotionOutputs tiles = mTileMotion.add(graph, inputs.motionDepth, params);
    const SortedBlocks blocks = mSorter.add(graph, tiles, params, false);
    mSorter.addCounters(graph, blocks, params, inputs.slot);
    const graph::ImageHandle target =
        mStillPixels.begin(graph, inputs.color, inputs.target, mStillPixelsBy);

    MotionBlurOutputs outputs;
    outputs.tiles = tiles.tiles;
    outputs.dominant = tiles.dominant;
    outputs.blocks = blocks;
    graph::ImageHandle filtered;
    if (method == Method::OwnVelocity) {
        filtered = mOwnVelocity.add(
            graph, std::array{inputs.color, inputs.motionDepth}, blocks.lists, target, params
        );
    } else if (method == Method::Guertin2014) {
        const GuertinTilesOutputs directed = mGuertinTiles.add(graph, tiles.tiles, params);
        outputs.dominant = directed.dominant;
        outputs.variance = directed.variance;
        filtered = mGuertin.add(
            graph,
            std::array{inputs.color, inputs.motionDepth, directed.dominant, directed.variance},
            blocks.lists,
            target,
            params
        );
    } else {
        const BlockFilter& filter = method == Method::McGuire2012 ? mMcGuire : mJimenez;
        filtered = filter.add(
            graph,
            std::array{inputs.color, inputs.motionDepth, tiles.dominant},
            blocks.lists,
            target,
            params
        );
    }
    outputs.cost = mCostView.add(graph, inputs.motionDepth, {}, blocks, params);
    outputs.color =
        mStillPixels.end(graph, inputs.color, filtered, blocks, false, params, mStillPixelsBy);
    return outputs;
}

MotionBlurOutputs MotionBlur::addDenoised(
    graph::Graph& graph,
    const MotionBlurInputs& inputs,
    const MotionBlurSettings& settings,
    const MotionBlurParams& resolved
) const {
    SHUTTER_CHECK(
        inputs.timedRays && mStochasticRays, "the denoised method needs moving rays, by ray queries"
    );
    MotionBlurParams params = resolved;
    params.frame = inputs.timedRays->frame;
    params.moving = inputs.timedRays->moving;
    const StochasticRaysOutputs rays = mStochasticRays->add(graph, *inputs.timedRays, params);
    const TileMotionOutputs tiles = mTileMotion.add(graph, rays.motionDepth, params);
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

MotionBlurCounters MotionBlur::counters(uint32_t slot) const {
    MotionBlurCounters counters;
    counters.blocks = mSorter.counters(slot);
    if (!mRayReveal)
        return counters;
    const shader::MaskHeader header = mRayReveal->lastHeader(slot);
    counters.maskedPixels = header.listedPixels + header.sharingPixels;
    counters.raysTraced = header.raysTraced;
    return counters;
}

} // namespace shutter::motion_blur
