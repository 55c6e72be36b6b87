// SPDX-License-Identifier: MIT
#include "engine/render/frame_overlays.h"

#include "engine/core/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace shutter::render {

namespace {

void explainInstants(Explainer& explainer, const OverlayPlan& plan) {
    const std::string reason = fmt::format(
        "{} in {} of the exposure, against the depth {}",
        core::countOf(plan.instants.instantCount, "instant"),
        core::countOf(plan.instants.partCount, "part"),
        plan.readsSurfaces ? "that each instant has" : "of the raster"
    );
    explainer.decide(ExplainedKind::Work, plan.label + " instants", {true, reason});
}

uint64_t countSurfaceBytes(const shader::InstantSurfaces& instants) {
    const glm::uvec2 allocated = shader::sizeInSteps(instants.sizePx);
    return uint64_t(shader::surfaceWordsPerPixel(instants)) * sizeof(uint32_t) * allocated.x *
           allocated.y;
}

/// Whether the surfaces of `all` are those that `one` needs.
bool holds(const shader::InstantSurfaces& all, const shader::InstantSurfaces& one) {
    return glm::all(glm::lessThanEqual(all.originPx, one.originPx)) &&
           glm::all(glm::lessThanEqual(one.originPx + one.sizePx, all.originPx + all.sizePx)) &&
           one.instantCount <= all.instantCount;
}

graph::ImageHandle declareBlack(graph::Graph& graph, const extract::ViewRequest& view) {
    struct Data {
        graph::ImageHandle image;
    };

    return graph
        .addPass<Data>(
            "black",
            graph::PassKind::Raster,
            [&](graph::PassBuilder& builder, Data& data) {
                data.image = builder.colorTarget(
                    graph.createImage(
                        "black", {view.width, view.height, VK_FORMAT_R16G16B16A16_SFLOAT}
                    ),
                    graph::ClearColor::floats(0.0f, 0.0f, 0.0f, 1.0f)
                );
            },
            [](const Data&, graph::PassContext&) {}
        )
        .image;
}

} // namespace

uint32_t fitInstants(shader::InstantSurfaces wanted, uint64_t bytes) {
    const uint32_t parts = wanted.partCount;
    for (; wanted.instantCount > 0; --wanted.instantCount) {
        wanted.partCount = std::min(wanted.instantCount, parts);
        const uint64_t words =
            uint64_t(shader::surfaceWordsPerPixel(wanted)) * wanted.sizePx.x * wanted.sizePx.y;
        if (words * sizeof(uint32_t) + sizeof(wanted) <= bytes)
            break;
    }
    return wanted.instantCount;
}

core::Status FrameOverlays::extract(
    std::span<Overlay* const> overlays, const OverlayExtract& source, bool areTakers
) {
    for (Overlay* overlay : overlays) {
        auto planned = overlay->extract(source);
        if (!planned)
            return planned.error();
        OverlayPlan& plan = planned.value();
        std::move(
            plan.explanations.begin(), plan.explanations.end(), std::back_inserter(mExplanations)
        );
        if (!plan.draws)
            continue;
        Drawn drawn{overlay, std::move(plan)};
        drawn.isTaker = areTakers;
        if (drawn.plan.readsSurfaces)
            shareSurfaces(drawn);
        mDrawn.push_back(std::move(drawn));
    }
    return {};
}

void FrameOverlays::shareSurfaces(Drawn& drawn) {
    shader::InstantSurfaces& instants = drawn.plan.instants;
    // Over another overlay there is one background: that of its parts is seen through it.
    if (!mDrawn.empty())
        instants.partCount = 1;
    for (const Drawn& below : mDrawn) {
        if (!below.plan.readsSurfaces || !holds(below.plan.instants, instants))
            continue;
        instants.instantCount = below.plan.instants.instantCount;
        drawn.words = below.words;
        return;
    }
    drawn.isOwner = true;
    drawn.words = mSurfaces.size();
    mSurfaces.push_back(instants);
}

void FrameOverlays::count(Counters& counters) const {
    for (const Drawn& drawn : mDrawn) {
        const OverlayPlan& plan = drawn.plan;
        if (plan.instants.instantCount == 0)
            continue;
        counters[plan.label + " instants"] = plan.instants.instantCount;
        const uint64_t bytes =
            plan.imageBytes + (drawn.isOwner ? countSurfaceBytes(plan.instants) : 0);
        if (bytes > 0)
            counters[plan.label + " bytes"] = bytes;
    }
}

graph::ImageHandle FrameOverlays::declare(
    OverlayContext context,
    bool areTakers,
    std::span<const graph::BufferHandle> words,
    Explainer& explainer
) const {
    for (const Drawn& drawn : mDrawn) {
        if (drawn.isTaker != areTakers)
            continue;
        context.surfaces.reset();
        if (drawn.plan.readsSurfaces)
            context.surfaces = {drawn.plan.instants, words[drawn.words]};
        if (drawn.plan.instants.instantCount > 0)
            explainInstants(explainer, drawn.plan);
        context.color = drawn.overlay->declare(context);
    }
    return context.color;
}

void FrameOverlays::publishAlone(
    const OverlayContext& context, Intermediates& intermediates, Explainer& explainer
) const {
    for (const Drawn& drawn : mDrawn) {
        const std::string name = drawn.overlay->name();
        if (drawn.isTaker || !intermediates.isWanted(name))
            continue;
        explainer.declareOwned(
            context.graph,
            PassOwner::Display,
            fmt::format("{} are shown alone", name),
            [&] {
                OverlayContext alone = context;
                alone.color = declareBlack(context.graph, context.view);
                intermediates.publish(name, drawn.overlay->declare(alone));
            }
        );
    }
}

} // namespace shutter::render
