// SPDX-License-Identifier: MIT
#include "modules/motion_blur/plugin/motion_blur_plugin.h"

#include "engine/gpu/address.h"

#include <fmt/format.h>

namespace shutter::motion_blur {

namespace {

void explainBudget(render::Explainer& explainer, const BudgetController& budget) {
    const std::string& gaveUp = budget.current().gaveUp;
    std::string reason = "the budget is unlimited";
    if (!budget.budget().isUnlimited())
        reason = gaveUp.empty()
                     ? fmt::format("all fits into {} ms", budget.budget().milliseconds)
                     : fmt::format(
                           "{} ms are too few: gave up {}", budget.budget().milliseconds, gaveUp
                       );
    explainer.decide(render::ExplainedKind::Work, "blur budget", {!gaveUp.empty(), reason});
}

} // namespace

MotionBlurPlugin::MotionBlurPlugin(
    gpu::Device& device,
    const gpu_scene::GpuScene& scene,
    const MotionBlurSettings& settings,
    const BlurBudget& budget
)
    : mWanted(settings), mBudget(budget, settings), mEffect(device, scene.textureLayout()) {}

void MotionBlurPlugin::configure(const MotionBlurSettings& settings, const BlurBudget& budget) {
    if (settings != mWanted || budget.milliseconds != mBudget.budget().milliseconds)
        mBudget = BudgetController(budget, settings);
    mWanted = settings;
}

core::Decision MotionBlurPlugin::ask(const render::ViewFacts& facts) const {
    if (settings().method == Method::Hybrid && !facts.deviceHasRays)
        return {false, "it needs rays, which the device cannot trace"};
    if (!(facts.exposureSeconds > 0.0))
        return {false, "the exposure is 0"};
    if (!facts.moves)
        return {false, "nothing in the picture moves during the exposure"};
    if (!mBudget.current().runs)
        return {
            false, fmt::format("{} ms are too few for any blur", mBudget.budget().milliseconds)};
    return {true, "something in the picture moves during the exposure"};
}

core::Decision MotionBlurPlugin::askRays(const render::ViewFacts& facts) const {
    if (settings().method != Method::Hybrid)
        return {}; // it never does
    // Other tests than by mesh id, and steps that end at a limit, show an entity behind itself.
    if (settings().objectTest != ObjectTest::MeshId ||
        settings().revealTraversal != RevealTraversal::Single)
        return {true, "an entity may come into sight behind itself"};
    return facts.reveal;
}

core::Decision MotionBlurPlugin::askTimedRays(const render::ViewFacts&) const {
    if (settings().method != Method::Denoised)
        return {}; // it never does
    return {true, "its method has rays with times of their own"};
}

void MotionBlurPlugin::declare(render::PostContext& context) {
    MotionBlurInputs inputs;
    inputs.color = context.color;
    inputs.motionDepth = context.gbuffer.motionDepth;
    inputs.normal = context.gbuffer.normal;
    inputs.entityId = context.gbuffer.entityId;
    inputs.rasterTime = context.facts.rasterTime;
    inputs.response = gpu::splitAddress(context.response);
    inputs.colorIsWritable = true;
    inputs.measureEdgesEverywhere = context.intermediates.isWanted("edge");
    RayInputs sky;
    sky.frame = gpu::splitAddress(context.frameConstants);
    inputs.rays = sky;
    if (context.rays)
        inputs.rays = RayInputs{
            context.rays->tlasBuffer,
            context.rays->movingTlasBuffer,
            context.rays->deformedBlasBuffer,
            context.rays->deformedBuffer,
            context.rays->tlas,
            context.rays->textures,
            gpu::splitAddress(context.rays->frameConstants),
            context.rays->hasBlended};
    if (context.timedRays)
        inputs.timedRays = TimedRayInputs{
            context.timedRays->tlasBuffer,
            context.timedRays->boxesBuffer,
            context.timedRays->deformedBuffer,
            context.timedRays->tlas,
            context.timedRays->textures,
            gpu::splitAddress(context.timedRays->frameConstants),
            gpu::splitAddress(context.timedRays->timedConstants)};
    mDrawn.at(context.slot) = {settings().method, mBudget.level()};
    inputs.slot = context.slot;
    const MotionBlurOutputs outputs = mEffect.add(context.graph, inputs, settings());
    explainBudget(context.explainer, mBudget);
    if (settings().method == Method::Hybrid && !context.rays)
        context.explainer.decide(
            render::ExplainedKind::Pass, "ray reveal", {false, context.facts.reveal.reason}
        );
    context.color = outputs.color;
    const std::pair<const char*, graph::ImageHandle> views[] = {
        {"tiles", outputs.dominant},
        {"variance", outputs.variance},
        {"edge", outputs.edge},
        {"mask", outputs.mask},
        {"reveal", outputs.revealColor},
        {"reveal_motion", outputs.revealMotionDepth},
        {"reveal_id", outputs.revealEntityId},
        {"cost", outputs.cost},
        {"noisy", outputs.noisy}};
    for (const auto& [name, image] : views)
        if (image.isValid())
            context.intermediates.publish(name, image);
}

void MotionBlurPlugin::finish(render::FinishedFrame& frame) {
    const Drawn& drawn = mDrawn.at(frame.slot);
    double milliseconds = 0.0;
    for (const gpu::PassTime& pass : frame.passes)
        milliseconds += pass.gpuMilliseconds;
    if (!frame.passes.empty())
        mBudget.observe(drawn.level, milliseconds);
    else if (!mBudget.current().runs) // and waits to be tried again
        mBudget.observe(mBudget.level(), 0.0);
    if (!frame.ran)
        return;
    count(frame);
    frame.measures["blur ms"] = milliseconds;
    if (!mBudget.budget().isUnlimited())
        frame.measures["blur budget level"] = double(drawn.level);
}

void MotionBlurPlugin::count(const render::FinishedFrame& frame) const {
    const MotionBlurCounters counted = mEffect.counters(frame.slot);
    const Method method = mDrawn.at(frame.slot).method;
    render::Counters& counters = frame.counters;
    if (method != Method::Denoised) {
        counters["blocks still"] = counted.blocks.still;
        counters["blocks uniform"] = counted.blocks.uniform;
        counters["blocks mixed"] = counted.blocks.mixed;
        counters["blocks masked"] = counted.blocks.masked;
    }
    if (method != Method::Hybrid)
        return;
    counters["pixels masked"] = counted.maskedPixels;
    counters["rays traced"] = counted.raysTraced;
}

} // namespace shutter::motion_blur
