// SPDX-License-Identifier: MIT
#include "modules/motion_blur/plugin/motion_blur_plugin.h"

namespace shutter::motion_blur {

MotionBlurPlugin::MotionBlurPlugin(
    gpu::Device& device, const render::GpuScene& scene, const MotionBlurSettings& settings
)
    : mSettings(settings), mEffect(device, scene.textureLayout()) {}

render::Decision MotionBlurPlugin::ask(const render::ViewFacts& facts) const {
    if (!(facts.exposureSeconds > 0.0))
        return {false, "the exposure is 0"};
    if (!facts.moves)
        return {false, "nothing in the picture moves during the exposure"};
    return {true, "something in the picture moves during the exposure"};
}

render::Decision MotionBlurPlugin::askRays(const render::ViewFacts&) const {
    if (mSettings.method != Method::Hybrid)
        return {false, "its method reveals nothing"};
    return {true, "a background may come into sight behind what moves"};
}

render::Decision MotionBlurPlugin::askMovingRays(const render::ViewFacts&) const {
    if (mSettings.method != Method::Denoised)
        return {false, "its method has no rays with times of their own"};
    return {true, "its method has rays with times of their own"};
}

void MotionBlurPlugin::declare(render::PostContext& context) {
    MotionBlurInputs inputs;
    inputs.color = context.color;
    inputs.motionDepth = context.gbuffer.motionDepth;
    inputs.normal = context.gbuffer.normal;
    inputs.meshId = context.gbuffer.meshId;
    inputs.rasterShare = context.facts.rasterShare;
    inputs.response = render::splitAddress(context.response);
    inputs.colorIsWritable = true;
    inputs.measureEdgesEverywhere = context.intermediates.isWanted("edge");
    if (context.rays)
        inputs.rays = RayInputs{
            context.rays->topLevelBuffer,
            context.rays->movingLevelBuffer,
            context.rays->shapeLevelsBuffer,
            context.rays->shapesBuffer,
            context.rays->topLevel,
            context.rays->textures,
            render::splitAddress(context.rays->frameConstants),
            context.rays->hasBlended};
    if (context.movingRays)
        inputs.movingRays = MovingRayInputs{
            context.movingRays->topLevelBuffer,
            context.movingRays->boxesBuffer,
            context.movingRays->shapesBuffer,
            context.movingRays->topLevel,
            context.movingRays->textures,
            render::splitAddress(context.movingRays->frameConstants),
            render::splitAddress(context.movingRays->movingConstants)};
    const MotionBlurOutputs outputs = mEffect.add(context.graph, inputs, mSettings);
    context.color = outputs.color;
    const std::pair<const char*, graph::ImageHandle> views[] = {
        {"tiles", outputs.dominant},
        {"variance", outputs.variance},
        {"edge", outputs.edge},
        {"mask", outputs.mask},
        {"reveal", outputs.revealColor},
        {"reveal_motion", outputs.revealMotionDepth},
        {"reveal_id", outputs.revealMeshId},
        {"noisy", outputs.noisy}};
    for (const auto& [name, image] : views)
        if (image.isValid())
            context.intermediates.publish(name, image);
}

void MotionBlurPlugin::collect(render::Counters& counters) {
    if (mSettings.method != Method::Hybrid)
        return;
    const MotionBlurCounters counted = mEffect.counters();
    counters["pixels masked"] = counted.maskedPixels;
    counters["rays traced"] = counted.raysTraced;
}

} // namespace shutter::motion_blur
