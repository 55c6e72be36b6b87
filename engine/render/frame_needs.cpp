// SPDX-License-Identifier: MIT
#include "engine/render/frame_needs.h"

#include "engine/core/words.h"
#include "engine/render/overlay.h"

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

const DecideContext::TakenRows& DecideContext::findTakenRows(bool usesLens) const {
    std::optional<TakenRows>& taken = found[usesLens ? 1 : 0];
    if (taken)
        return *taken;
    taken.emplace();
    for (Overlay* overlay : overlays) {
        const std::vector<uint32_t> own = overlay->findRows(*this, usesLens);
        if (own.empty())
            continue;
        taken->takers.push_back(overlay);
        std::vector<uint32_t> all;
        std::set_union(
            taken->rows.begin(), taken->rows.end(), own.begin(), own.end(), std::back_inserter(all)
        );
        taken->rows = std::move(all);
    }
    return *taken;
}

FrameNeeds
joinNeeds(const DecideContext& context, std::span<Effect* const> effects, Explainer& explainer) {
    const ViewFacts& facts = context.facts;
    FrameNeeds all;
    all.samplesEdges = context.view.samplesEdges && !context.frame.isCameraAtRest;
    all.rays = all.timedRays = {false, "no effect that runs traces any"};
    all.secondRaster = all.lastRaster = {false, "no effect that runs needs it"};
    all.layer = {false, "no effect that runs draws one"};
    for (Effect* effect : effects) {
        Needs needs = effect->decide(context);
        const bool traces = needs.rays.run || needs.timedRays.run;
        if (needs.run.run && traces && !facts.deviceHasRays)
            needs.run = {false, "it needs rays, which the device cannot trace"};
        if (needs.run.run && needs.timedRays.run && !facts.deviceHasRayQuery)
            needs.run = {false, "it needs ray queries, which the device lacks"};
        explainer.decide(ExplainedKind::Effect, effect->name(), needs.run);
        join(all.exposure, effect->name(), needs.exposure);
        if (needs.exposure.run)
            all.overlaysAt = all.running.size() + (needs.run.run ? 1 : 0);
        if (!needs.run.run)
            continue;
        if (!all.layer.run && needs.movingBlended.run) {
            all.taken = context.findTakenRows(needs.usesLens);
            needs.movingBlended = describeLayer(all.taken.rows, context.layout);
        }
        join(all.layer, effect->name(), needs.movingBlended);
        const bool isBelowOverlays = needs.exposure.run || needs.movingBlended.run;
        if (isBelowOverlays) {
            all.limits = needs.overlays;
            all.limits.hasLens = needs.usesLens;
        }
        all.running.push_back(
            {effect, needs.secondRaster.run, needs.lastRaster.run, isBelowOverlays}
        );
        all.readsEdges = all.readsEdges || needs.edges;
        all.readsNormals = all.readsNormals || needs.normals;
        all.mayTrace = all.mayTrace || !needs.rays.reason.empty();
        join(all.rays, effect->name(), needs.rays);
        join(all.timedRays, effect->name(), needs.timedRays);
        join(all.secondRaster, effect->name(), needs.secondRaster);
        join(all.lastRaster, effect->name(), needs.lastRaster);
    }
    return all;
}

} // namespace shutter::render
