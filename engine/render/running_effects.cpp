// SPDX-License-Identifier: MIT
// Joins the requests of a frame's effects, and frees resources that none requested for a while.
#include "engine/core/check.h"
#include "engine/core/words.h"
#include "engine/extract/raster_record.h"
#include "engine/render/renderer.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace shutter::render {

namespace {

/// Joins decisions of effects: the first that runs, or else the last reason to skip.
void join(core::Decision& all, const std::string& effect, const core::Decision& own) {
    if (!all.run && !own.reason.empty())
        all = {own.run, effect + ": " + own.reason};
}

/// \param rows that DecideContext::findTakenRows() found
core::Decision
describeLayer(const std::vector<uint32_t>& rows, const extract::SceneLayout& layout) {
    if (rows.empty())
        return {
            false,
            layout.hasBlended ? "blended surfaces move as what is around them does"
                              : "the scene has no blended surface"};
    return {
        true,
        core::countOf(rows.size(), "entity has", "entities have") +
            " blended surfaces that do not move as what is around them does"};
}

} // namespace

const std::vector<uint32_t>& DecideContext::findTakenRows(bool usesLens) const {
    std::optional<std::vector<uint32_t>>& taken = found[usesLens ? 1 : 0];
    if (taken)
        return *taken;
    taken.emplace();
    for (const Overlay* overlay : overlays) {
        const std::vector<uint32_t> own = overlay->findRows(*this, usesLens);
        std::vector<uint32_t> all;
        std::set_union(
            taken->begin(), taken->end(), own.begin(), own.end(), std::back_inserter(all)
        );
        *taken = std::move(all);
    }
    return *taken;
}

Renderer::RunningEffects Renderer::joinNeeds(
    const DecideContext& context, std::span<Effect* const> effects, Explainer& explainer
) {
    const ViewFacts& facts = context.facts;
    RunningEffects running;
    running.samplesEdges = context.view.samplesEdges && !context.frame.isCameraAtRest;
    running.rays = running.timedRays = {false, "no effect that runs traces any"};
    running.secondRaster = running.lastRaster = {false, "no effect that runs needs it"};
    running.layer = {false, "no effect that runs draws one"};
    for (Effect* effect : effects) {
        Needs needs = effect->decide(context);
        const bool traces = needs.rays.run || needs.timedRays.run;
        if (needs.run.run && traces && !facts.deviceHasRays)
            needs.run = {false, "it needs rays, which the device cannot trace"};
        if (needs.run.run && needs.timedRays.run && !facts.deviceHasRayQuery)
            needs.run = {false, "it needs ray queries, which the device lacks"};
        explainer.decide(ExplainedKind::Effect, effect->name(), needs.run);
        join(running.exposure, effect->name(), needs.exposure);
        if (needs.exposure.run)
            running.overlaysAt = running.effects.size() + (needs.run.run ? 1 : 0);
        if (!needs.run.run)
            continue;
        if (!running.layer.run && needs.movingBlended.run) {
            running.takenRows = context.findTakenRows(needs.usesLens);
            needs.movingBlended = describeLayer(running.takenRows, context.layout);
        }
        join(running.layer, effect->name(), needs.movingBlended);
        if (needs.exposure.run) {
            running.limits = needs.overlays;
            running.limits.hasLens = needs.usesLens;
        }
        running.effects.push_back(
            {effect, needs.secondRaster.run, needs.lastRaster.run, needs.exposure.run}
        );
        running.readsEdges = running.readsEdges || needs.edges;
        running.readsNormals = running.readsNormals || needs.normals;
        running.mayTrace = running.mayTrace || !needs.rays.reason.empty();
        join(running.rays, effect->name(), needs.rays);
        join(running.timedRays, effect->name(), needs.timedRays);
        join(running.secondRaster, effect->name(), needs.secondRaster);
        join(running.lastRaster, effect->name(), needs.lastRaster);
    }
    return running;
}

core::Status Renderer::extractForEffects(
    ExtractContext& context, const RunningEffects& running, std::span<ShadingFeature* const> shading
) {
    const extract::SceneLayout& layout = mScene.layout();
    const std::vector<ecs::Entity> hidden = extract::listEntities(context.frame, running.takenRows);
    // Nothing gathers the samples of static surfaces in these.
    extract::ViewRequest view = extract::withoutStaticSamples(context.view);
    view.samplesEdges = running.samplesEdges; // as this frame is drawn
    if (running.secondRaster.run)
        SHUTTER_TRY(mSecondRaster.use(context.slot)
                        .extract(
                            context.world,
                            layout,
                            makeViewOfOtherEnd(view),
                            {shading, hidden, RasterKind::Second, context.slot}
                        ));
    if (running.lastRaster.run) {
        const auto before = extract::makeViewBefore(context.world, view, context.motion);
        SHUTTER_CHECK(before.has_value(), "no frame before shows what this one does");
        SHUTTER_TRY(mLastRaster.use(context.slot)
                        .extract(
                            context.world,
                            layout,
                            *before,
                            {shading, hidden, RasterKind::Last, context.slot}
                        ));
    }
    for (const RunningEffect& one : running.effects) {
        context.secondRaster.reset();
        context.lastRaster.reset();
        if (one.readsSecondRaster)
            context.secondRaster = mSecondRaster.use(context.slot).extracted();
        if (one.readsLastRaster)
            context.lastRaster = mLastRaster.use(context.slot).extracted();
        one.effect->extract(context);
    }
    return {};
}

std::vector<Renderer::PendingEffect> Renderer::listPending(
    std::span<Effect* const> effects, const RunningEffects& running, const graph::Plan& plan
) {
    std::vector<PendingEffect> pending;
    for (Effect* effect : effects) {
        PendingEffect& own = pending.emplace_back();
        own.effect = effect;
        for (const RunningEffect& one : running.effects) {
            if (one.effect != effect)
                continue;
            own.ran = true;
            for (size_t i = 0; i < plan.passes.size(); ++i)
                if (plan.passes[i].pass >= one.firstPass && plan.passes[i].pass < one.endPass)
                    own.times.push_back(i);
        }
    }
    return pending;
}

void Renderer::releaseIdle(const RunningEffects& running) {
    mDeformation.endFrame();
    mFrameTlas.endFrame();
    mTimedScene.endFrame();
    mSecondRaster.endFrame();
    mLastRaster.endFrame();
    // Building bottom levels takes longer than a frame: an effect that may trace keeps them.
    mScene.releaseIdleBlas(running.mayTrace || running.timedRays.run);
}

} // namespace shutter::render
