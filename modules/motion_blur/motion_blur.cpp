// SPDX-License-Identifier: MIT
#include "modules/motion_blur/motion_blur.h"

#include "engine/core/check.h"

namespace shutter::motion_blur {

MotionBlur::MotionBlur(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
    : mTileMotion(device), mGather(device) {
    if (!sceneLayout || !device.hasRays())
        return;
    mRayMask = std::make_unique<RayMask>(device);
    mRayReveal = std::make_unique<RayReveal>(device, sceneLayout);
}

MotionBlurOutputs MotionBlur::add(
    graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurSettings& settings
) {
    const core::Status valid = validate(settings);
    SHUTTER_CHECK(valid.ok(), "{}", valid.error().message);
    const graph::TransientImageDesc& size = graph.describeImage(inputs.color);
    shader::MotionBlurParams params =
        resolve(settings, size.width, size.height, inputs.rasterShare);

    MotionBlurOutputs outputs;
    const TileMotionOutputs front = mTileMotion.add(graph, inputs.motionDepth, params, "");
    outputs.tiles = front.tiles;
    outputs.dominant = front.dominant;
    GatherInputs layers{inputs.color, inputs.motionDepth, front.dominant, {}};
    if (settings.method == Method::Hybrid) {
        SHUTTER_CHECK(inputs.rays && mRayReveal, "the hybrid method needs rays");
        params.frame = inputs.rays->frame;
        const RayMaskInputs maskInputs{
            inputs.motionDepth,
            inputs.normal,
            inputs.meshId,
            front.dominant,
            inputs.measureEdgesEverywhere};
        const RayMaskOutputs mask = mRayMask->add(graph, maskInputs, params);
        const RayRevealInputs revealInputs{
            inputs.color,
            inputs.motionDepth,
            inputs.meshId,
            mask.list,
            mask.arguments,
            *inputs.rays};
        const RayRevealOutputs reveal = mRayReveal->add(graph, revealInputs, params);
        const TileMotionOutputs behind =
            mTileMotion.add(graph, reveal.motionDepth, params, " of reveal");
        layers.reveal = RevealedLayer{reveal.color, reveal.motionDepth, behind.dominant, mask.mask};
        outputs.edge = mask.edge;
        outputs.mask = mask.mask;
        outputs.revealColor = reveal.color;
        outputs.revealMotionDepth = reveal.motionDepth;
        outputs.revealMeshId = reveal.meshId;
    }
    outputs.color = mGather.add(graph, layers, params);
    return outputs;
}

MotionBlurCounters MotionBlur::counters() const {
    if (!mRayReveal)
        return {};
    const shader::MaskHeader header = mRayReveal->lastHeader();
    return {header.maskedPixels, header.raysTraced};
}

} // namespace shutter::motion_blur
