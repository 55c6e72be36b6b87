// SPDX-License-Identifier: MIT
#include "modules/glass/glass.h"

#include "engine/core/check.h"

namespace shutter::glass {

std::vector<uint32_t> Glass::findRows(const render::DecideContext& context, bool usesLens) const {
    return findLayerRows(
        context.world, context.layout, context.view, context.motion, context.frame, usesLens
    );
}

core::Result<render::OverlayPlan> Glass::extract(const render::OverlayExtract& source) {
    BlendedLayer& layer = mLayers.at(source.slot);
    layer = {};
    extract::ViewRequest view = source.view;
    view.jitterPx = source.jitterPx;
    layer = planBlendedLayer(
        source.world,
        source.layout,
        view,
        source.frameView.motion(),
        source.frame,
        source.takenRows,
        source.limits
    );
    if (layer.empty())
        return render::OverlayPlan{};
    const shader::InstantSurfaces rectangle = layer.surfaces();
    const glm::uvec2 allocated = shader::sizeInSteps(rectangle.sizePx);
    // Two images of the drawn part and, with several parts, the sum of the earlier ones.
    const uint64_t perPixel = layer.partCount > 1 ? 24 : 16;
    return render::OverlayPlan{
        .draws = true,
        .instants = rectangle,
        .readsSurfaces = layer.readsInstants,
        .imageBytes = perPixel * allocated.x * allocated.y,
        .label = "blended"};
}

graph::ImageHandle Glass::declare(const render::OverlayContext& context) {
    SHUTTER_CHECK(context.composite, "an effect for which rows leave the raster composites them");
    const BlendedLayer& layer = mLayers.at(context.slot);
    const graph::BufferHandle words =
        context.surfaces ? context.surfaces->words : graph::BufferHandle{};
    const shader::InstantSurfaces rectangle = layer.surfaces();
    std::vector<float> shares(layer.partCount, 0.0f);
    for (uint32_t i = 0; i < rectangle.instantCount; ++i)
        shares[shader::surfacePartOf(rectangle, i)] += layer.instants[i].weight;
    return (*context.composite)(
        context.color,
        [&](uint32_t part) {
            render::OverlayPart drawn = mPass.declare(context, layer, words, part);
            drawn.share = shares[part];
            return drawn;
        },
        rectangle,
        words
    );
}

} // namespace shutter::glass
