// SPDX-License-Identifier: MIT
#include "modules/motion_blur/plugin/instant_motion_buffers.h"

#include "engine/scene/exposure_motion.h"

#include <utility>

namespace shutter::motion_blur {

namespace {

extract::RasterRecord
describeRaster(const scene::World& world, const render::OtherRasterView& drawn) {
    const extract::ViewRequest& view = *drawn.view;
    const scene::ExposureMotion motion(world, view.camera, view.exposure);
    return extract::makeRasterRecord(world, view, motion, *drawn.frame, view.exposure.rasterTime);
}

} // namespace

bool InstantMotionBuffers::isOfFrameBefore(
    const scene::World& world,
    const extract::ViewRequest& view,
    const std::optional<extract::RasterRecord>& record
) const {
    if (!record)
        return false;
    const scene::ExposureMotion motion(world, view.camera, view.exposure);
    return extract::isOfFrameBefore(world, view, motion, *record);
}

bool InstantMotionBuffers::isAgain(const scene::World& world, const extract::ViewRequest& view)
    const {
    if (!mLast)
        return false;
    const scene::ExposureMotion motion(world, view.camera, view.exposure);
    return extract::isOfSameFrame(world, view, motion, *mLast) &&
           isOfFrameBefore(world, view, mBefore);
}

bool InstantMotionBuffers::holdsFrameBefore(
    const scene::World& world, const extract::ViewRequest& view
) const {
    return isOfFrameBefore(world, view, mLast) || isAgain(world, view);
}

extract::InstantTables InstantMotionBuffers::computeTables(
    const render::PostContext& context, uint32_t instantCount
) const {
    const render::OtherRasterView* const second = context.secondRaster;
    std::optional<extract::InstantFrame> secondFrame;
    if (second)
        secondFrame.emplace(*second->view->instant, *second->frame, second->view->jitterPx);
    const extract::RasterRecord* last = mLast ? &*mLast : nullptr;
    std::optional<extract::RasterRecord> drawnAnew;
    if (const render::OtherRasterView* const drawn = context.lastRaster)
        last = &drawnAnew.emplace(describeRaster(context.world, *drawn));
    extract::ViewRequest view = context.view;
    view.jitterPx = context.colorJitterPx;
    return extract::computeInstantTables(
        context.world,
        view,
        context.frame,
        instantCount,
        last,
        secondFrame ? &*secondFrame : nullptr
    );
}

InstantMotions InstantMotionBuffers::update(
    const render::PostContext& context, uint32_t instantCount, bool hasHistory
) {
    if (!hasHistory)
        forget();
    else if (!context.lastRaster && isAgain(context.world, context.view))
        stepBack();
    extract::InstantTables tables = computeTables(context, instantCount);
    InstantMotions motions;
    motions.table = writeInstantLayers(mDevice, tables, mBuffers.at(context.slot));
    motions.instantCount = instantCount;
    motions.hasLast = tables.last.has_value();
    motions.deforms = {
        tables.raster.deforms,
        tables.last && tables.last->deforms,
        tables.second && tables.second->deforms};
    motions.mayCrowd = mayCrowdTiles(tables);
    motions.drawWays = declareWays(context, tables);
    if (const render::OtherRasterView* const second = context.secondRaster)
        motions.second = SecondRaster{
            second->gbuffer.color, second->gbuffer.motionDepth, second->gbuffer.entityId};
    if (const render::OtherRasterView* const last = context.lastRaster)
        motions.lent =
            LentRaster{last->gbuffer.color, last->gbuffer.motionDepth, last->gbuffer.entityId};
    if (!hasHistory)
        return motions;
    motions.history = &mHistory;
    motions.keepsRaster = context.facts.isFollowed;
    if (!motions.keepsRaster)
        return motions;
    mBefore = std::move(mLast);
    mLast = std::move(tables.record);
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
    if (const render::OtherRasterView* const last = context.lastRaster)
        layers[size_t(LayerIndex::Last)] = {tables.lastWays, {last->frame, &last->shapes}};
    else
        layers[size_t(LayerIndex::Last)] = {tables.lastWays, {}, mLast ? &*mLast : nullptr};
    if (const render::OtherRasterView* const second = context.secondRaster)
        layers[size_t(LayerIndex::Second)] = {tables.secondWays, {second->frame, &second->shapes}};
    ways->declareShapes(context.graph, now, tables.middles, layers, mScene);
    return
        [&ways = *ways, &scene = mScene](
            graph::Graph& graph, LayerIndex layer, graph::ImageHandle surface, uint32_t keyMask
        ) { return ways.declareLayer(graph, static_cast<size_t>(layer), surface, keyMask, scene); };
}

void InstantMotionBuffers::stepBack() {
    mHistory.stepBack();
    mLast = std::exchange(mBefore, std::nullopt);
}

void InstantMotionBuffers::forget() {
    mLast.reset();
    mBefore.reset();
    mHistory.forget();
}

} // namespace shutter::motion_blur
