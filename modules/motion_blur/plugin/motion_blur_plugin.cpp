// SPDX-License-Identifier: MIT
#include "modules/motion_blur/plugin/motion_blur_plugin.h"

#include "engine/core/words.h"
#include "engine/gpu/vulkan.h"
#include "shaders/motion_blur/resolved_shared.h"

#include <fmt/format.h>

#include <cstdint>

namespace shutter::motion_blur {

namespace {

constexpr uint32_t kListed = shader::kCandidatesPerTile;

void explainBudget(render::Explainer& explainer, const BudgetController& budget) {
    const std::string& droppedQuality = budget.current().droppedQuality;
    std::string reason = "the budget is unlimited";
    if (!budget.budget().isUnlimited())
        reason = droppedQuality.empty()
                     ? fmt::format("everything fits into {:.3g} ms", budget.budget().milliseconds)
                     : fmt::format(
                           "{:.3g} ms is too little: gave up {}",
                           budget.budget().milliseconds,
                           droppedQuality
                       );
    explainer.decide(render::ExplainedKind::Work, "blur budget", {!droppedQuality.empty(), reason});
}

void explainCrowds(render::FinishedFrame& frame) {
    const auto found = frame.counters.find("crowded tiles");
    if (found == frame.counters.end())
        return;
    const uint64_t count = found->second;
    const std::string reason = count == 0
                                   ? fmt::format("no tile may see more than {} movers", kListed)
                                   : fmt::format(
                                         "{} more than {} movers",
                                         core::countOf(count, "tile may see", "tiles may see"),
                                         kListed
                                     );
    frame.explanations.push_back(
        {render::ExplainedKind::Work, "search without lists", {count > 0, reason}}
    );
}

constexpr const char* kNoPicture = "the frame is drawn for the lookups of the next one";

/// In place of a level of the budget: the frame's time is not used.
constexpr size_t kNoLevel = SIZE_MAX;

} // namespace

std::string nameReplacement(const Method& wanted) {
    return fmt::format("{} is drawn by", wanted.name);
}

MotionBlurPlugin::MotionBlurPlugin(
    gpu::Device& device,
    const gpu_scene::GpuScene& scene,
    const MotionBlurSettings& settings,
    const BlurBudget& budget
)
    : mWanted(settings), mBudget(budget, settings), mInstantMotions(device, scene),
      mComposite(device), mEffect(device, scene.textureLayout()) {}

void MotionBlurPlugin::configure(
    const MotionBlurSettings& settings, const BlurBudget& budget, UntilReady untilReady
) {
    if (settings != mWanted)
        mBudget = BudgetController(budget, settings);
    else
        mBudget.setBudget(budget);
    mWanted = settings;
    mUntilReady = untilReady;
    chooseStandIn();
}

void MotionBlurPlugin::chooseStandIn() {
    mStandIn.reset();
    const MotionBlurSettings& wanted = mBudget.current().settings;
    if (mUntilReady == UntilReady::Wait || !wanted.method->standIn ||
        mEffect.isReady(*wanted.method))
        return;
    mStandIn = wanted;
    mStandIn->method = &getMethod(wanted.method->standIn);
}

core::Decision MotionBlurPlugin::decideRun(const render::ViewFacts& facts) const {
    if (settings().method->rays == RayNeed::Any && !facts.deviceHasRays)
        return {false, "it needs rays, which the device cannot trace"};
    if (usesLens(facts))
        return {true, "the lens is open"};
    const std::string lens =
        facts.usesLens && settings().method->readsLens ? ", and the lens leaves all in focus" : "";
    if (!(facts.exposureSeconds > 0.0))
        return {false, "the exposure is 0" + lens};
    if (!facts.moves)
        return {false, "nothing in the picture moves during the exposure" + lens};
    return {true, "something in the picture moves during the exposure" + lens};
}

bool MotionBlurPlugin::usesLens(const render::ViewFacts& facts) const {
    const Method& method = *settings().method;
    return method.readsLens && (method.readsInstantMotions ? facts.isDefocused : facts.usesLens);
}

core::Decision MotionBlurPlugin::decideRays(const render::ViewFacts& facts) const {
    const Method& method = *settings().method;
    if (method.alwaysTraces && method.alwaysTraces(settings()))
        return {true, "an entity may come into sight behind itself"};
    return facts.reveal;
}

bool MotionBlurPlugin::readsHistory() const {
    return settings().method->readsInstantMotions && settings().history;
}

bool MotionBlurPlugin::onlyKeeps(const render::ViewFacts& facts) const {
    return !facts.pictureWanted && settings().method->readsInstantMotions;
}

core::Decision MotionBlurPlugin::decideLastRaster(
    const render::DecideContext& context, const render::Needs& needs
) const {
    if (onlyKeeps(context.facts))
        return {false, kNoPicture};
    std::span<const uint32_t> taken;
    if (needs.movingBlended.run)
        taken = context.findTakenRows(needs.usesLens).rows;
    if (mInstantMotions.holdsFrameBefore(context, taken))
        return {false, "the frame before left its own"};
    if (!extract::makeViewBefore(context.world, context.view, context.motion))
        return {false, "the frame before shows something else"};
    return {true, "the frame before left none"};
}

render::Needs MotionBlurPlugin::decide(const render::DecideContext& context) const {
    const render::ViewFacts& facts = context.facts;
    const Method& method = *settings().method;
    const auto ifShown = [&](const char* reason) -> core::Decision {
        return onlyKeeps(facts) ? core::Decision{false, kNoPicture} : core::Decision{true, reason};
    };
    render::Needs needs;
    needs.run = decideRun(facts);
    needs.exposure = {false, "the exposure is 0"};
    if (facts.exposureSeconds > 0.0)
        needs.exposure = {true, "its picture shows the whole exposure"};
    if (method.sampleUnit == SampleUnit::Instants)
        needs.overlays.instants = settings().sampleCount;
    needs.overlays.findsInstants = method.readsInstantMotions;
    if (method.rays == RayNeed::Any)
        needs.rays = decideRays(facts);
    if (method.rays == RayNeed::Query)
        needs.timedRays = ifShown("its method has rays with times of their own");
    if (method.readsInstantMotions && settings().secondRaster)
        needs.secondRaster = ifShown("secondRaster is set");
    needs.movingBlended = {false, "its method draws them itself"};
    if (method.readsRaster)
        needs.movingBlended = {true, "blended surfaces are drawn over the blurred picture"};
    needs.usesLens = usesLens(facts);
    needs.edges = method.readsInstantMotions;
    needs.normals = method.readsNormal;
    if (needs.run.run && readsHistory())
        needs.lastRaster = decideLastRaster(context, needs);
    return needs;
}

void MotionBlurPlugin::extract(render::ExtractContext& context) {
    if (settings().method->readsInstantMotions)
        mInstantMotions.extract(
            context,
            {countInstants(settings(), usesLens(context.facts)), usesLens(context.facts)},
            settings().history
        );
}

void MotionBlurPlugin::declare(render::PictureContext& context) {
    MotionBlurInputs inputs;
    inputs.color = context.color;
    inputs.motionDepth = context.gbuffer.motionDepth;
    inputs.normal = context.gbuffer.normal;
    inputs.entityId = context.gbuffer.entityId;
    inputs.edgeSurface = context.gbuffer.edgeSurface;
    inputs.rasterTime = context.facts.rasterTime;
    inputs.frameNumber = scene::numberFrame(context.view.exposure);
    inputs.response = gpu::splitAddress(context.response);
    inputs.colorIsWritable = true;
    inputs.measureEdgesEverywhere = context.intermediates.isWanted("edge");
    if (context.rays)
        inputs.rays = *context.rays;
    else
        inputs.rays = graph::RayScene{.frameConstants = context.frameConstants};
    if (context.timedRays)
        inputs.timedRays = *context.timedRays;
    if (settings().method->readsInstantMotions)
        inputs.instantMotions = mInstantMotions.declare(context);
    const bool keepsOnly = onlyKeeps(context.facts);
    const bool standsIn = mStandIn.has_value();
    // Block counts are read back with every picture: they choose how static pixels of later frames
    // are copied.
    inputs.wantsPicture = inputs.wantsCounters = !keepsOnly;
    inputs.wantsMethodCounters = context.facts.countersWanted;
    const size_t level = keepsOnly || standsIn ? kNoLevel : mBudget.level();
    mDrawn.at(context.slot
    ) = {level, keepsOnly, standsIn, readsHistory(), mWanted.method, settings().method};
    inputs.slot = context.slot;
    inputs.surfaces = {context.surfaces.begin(), context.surfaces.end()};
    const MotionBlurOutputs outputs = mEffect.add(context.graph, inputs, settings());
    explainBudget(context.explainer, mBudget);
    if (standsIn)
        context.explainer.decide(
            render::ExplainedKind::Work,
            "stand-in",
            {true,
             fmt::format(
                 "{} draws until the pipelines of {} are made",
                 settings().method->name,
                 mBudget.current().settings.method->name
             )}
        );
    if (settings().method->rays == RayNeed::Any && !context.rays)
        context.explainer.decide(
            render::ExplainedKind::Pass, "ray reveal", {false, context.facts.reveal.reason}
        );
    context.color = outputs.color;
    context.surfaceWords = outputs.surfaces;
    context.compositeParts = [this, &graph = context.graph](
                                 graph::ImageHandle picture,
                                 const auto& draw,
                                 const shader::InstantSurfaces& rectangle,
                                 graph::BufferHandle words
                             ) {
        const auto drawPart = [&](uint32_t part) -> BlendedSums {
            const render::OverlayPart drawn = draw(part);
            return {drawn.color, drawn.opacity, drawn.share};
        };
        return mComposite.add(graph, picture, drawPart, rectangle, words);
    };
    for (const View& view : outputs.views)
        context.intermediates.publish(std::string(view.name), view.image);
}

void MotionBlurPlugin::finish(render::FinishedFrame& frame) {
    const Drawn& drawn = mDrawn.at(frame.slot);
    double milliseconds = 0.0;
    for (const gpu::PassTime& pass : frame.passes)
        milliseconds += pass.gpuMilliseconds;
    if (!frame.passes.empty())
        mBudget.observe(drawn.level, milliseconds);
    chooseStandIn();
    if (mHistoryIdle.advance(frame.ran && drawn.hasHistory))
        mInstantMotions.forget();
    if (!frame.ran || drawn.keepsOnly)
        return;
    for (const auto& [name, value] : mEffect.counters(frame.slot))
        frame.counters[name] = value;
    explainCrowds(frame);
    frame.measures["blur ms"] = milliseconds;
    if (drawn.method != drawn.wanted)
        frame.explanations.push_back(
            {render::ExplainedKind::Work,
             nameReplacement(*drawn.wanted),
             {true, drawn.method->name}}
        );
    if (drawn.standsIn)
        frame.measures["blur stands in"] = 1.0;
    else if (!mBudget.budget().isUnlimited())
        frame.measures["blur budget level"] = double(drawn.level);
}

} // namespace shutter::motion_blur
