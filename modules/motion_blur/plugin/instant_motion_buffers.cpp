// SPDX-License-Identifier: MIT
#include "modules/motion_blur/plugin/instant_motion_buffers.h"

#include <utility>

namespace shutter::motion_blur {

InstantMotions InstantMotionBuffers::update(
    const render::PostContext& context, uint32_t instantCount, bool keepsRaster
) {
    if (!keepsRaster)
        forget();
    const render::SecondRasterView* const second = context.secondRaster;
    std::optional<extract::InstantFrame> secondFrame;
    if (second)
        secondFrame.emplace(second->instant, *second->frame, context.view.jitterPx);
    extract::ViewRequest view = context.view;
    view.jitterPx = context.colorJitterPx;
    extract::InstantTables tables = extract::computeInstantTables(
        context.world,
        view,
        context.frame,
        instantCount,
        mLast ? &*mLast : nullptr,
        secondFrame ? &*secondFrame : nullptr
    );
    InstantMotions motions;
    motions.table = writeInstantLayers(mDevice, tables, mBuffers.at(context.slot));
    motions.instantCount = instantCount;
    motions.hasLast = tables.last.has_value();
    motions.deforms = {
        tables.raster.deforms,
        tables.last && tables.last->deforms,
        tables.second && tables.second->deforms};
    motions.drawWays = declareWays(context, tables);
    if (second)
        motions.second = SecondRaster{
            second->gbuffer.color, second->gbuffer.motionDepth, second->gbuffer.entityId};
    if (keepsRaster) {
        motions.history = &mHistory;
        mLast = std::move(tables.record);
    }
    return motions;
}

DrawWays InstantMotionBuffers::declareWays(
    const render::PostContext& context, const extract::InstantTables& tables
) {
    if (tables.rasterWays.empty() && tables.lastWays.empty() && tables.secondWays.empty())
        return {};
    auto& ways = mWays.at(context.slot);
    if (!ways)
        ways.emplace(mDevice);
    const render::ShapedFrame now{&context.frame, &context.shapes};
    std::array<render::ShapeWayLayer, 3> layers;
    layers[size_t(LayerIndex::Raster)] = {tables.rasterWays, now};
    layers[size_t(LayerIndex::Last)] = {tables.lastWays, {}, mLast ? &*mLast : nullptr};
    if (const render::SecondRasterView* const second = context.secondRaster)
        layers[size_t(LayerIndex::Second)] = {tables.secondWays, {second->frame, &second->shapes}};
    ways->declareShapes(context.graph, now, tables.middles, layers, mScene);
    return
        [&ways = *ways, &scene = mScene](
            graph::Graph& graph, LayerIndex layer, graph::ImageHandle surface, uint32_t keyMask
        ) { return ways.declareLayer(graph, static_cast<size_t>(layer), surface, keyMask, scene); };
}

void InstantMotionBuffers::forget() {
    mLast.reset();
    mHistory.forget();
}

} // namespace shutter::motion_blur
