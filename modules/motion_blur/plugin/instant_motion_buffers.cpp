// SPDX-License-Identifier: MIT
#include "modules/motion_blur/plugin/instant_motion_buffers.h"

#include "engine/scene/exposure_motion.h"

#include <span>
#include <utility>

namespace shutter::motion_blur {

namespace {

extract::RasterRecord
describeRaster(const scene::World& world, const render::ExtractedRaster& drawn) {
    const extract::ViewRequest& view = *drawn.view;
    const scene::ExposureMotion motion(world, view.camera, view.exposure);
    return extract::makeRasterRecord(world, view, motion, *drawn.frame, view.exposure.rasterTime);
}

/// \param context DecideContext or ExtractContext
/// \param taken rows whose blended surfaces are not in the raster
template <class Context>
bool isOfFrameBefore(
    const Context& context,
    std::span<const uint32_t> taken,
    const std::optional<extract::RasterRecord>& record
) {
    return record &&
           extract::isOfFrameBefore(context.world, context.view, context.motion, *record) &&
           record->taken == extract::listEntities(context.frame, taken);
}

} // namespace

template <class Context>
bool InstantMotionBuffers::isAgain(const Context& context, std::span<const uint32_t> taken) const {
    return mLast && extract::isOfSameFrame(context.world, context.view, context.motion, *mLast) &&
           isOfFrameBefore(context, taken, mBefore);
}

bool InstantMotionBuffers::holdsFrameBefore(
    const render::DecideContext& context, std::span<const uint32_t> taken
) const {
    return isOfFrameBefore(context, taken, mLast) || isAgain(context, taken);
}

extract::InstantTables InstantMotionBuffers::computeTables(
    const render::ExtractContext& context, const Instants& instants
) const {
    std::optional<extract::InstantFrame> secondFrame;
    if (const auto& second = context.secondRaster)
        secondFrame.emplace(*second->view->instant, *second->frame, second->view->jitterPx);
    const extract::RasterRecord* last =
        isOfFrameBefore(context, context.takenRows, mLast) ? &*mLast : nullptr;
    std::optional<extract::RasterRecord> redrawn;
    if (const auto& drawn = context.lastRaster)
        last = &redrawn.emplace(describeRaster(context.world, *drawn));
    extract::ViewRequest view = context.view;
    view.jitterPx = context.colorJitterPx;
    view.usesLens = instants.haveLens;
    return extract::computeInstantTables(
        context.world,
        view,
        context.motion,
        context.frame,
        instants.count,
        last,
        secondFrame ? &*secondFrame : nullptr,
        extract::listEntities(context.frame, context.takenRows)
    );
}

void InstantMotionBuffers::extract(
    const render::ExtractContext& context, const Instants& instants, bool hasHistory
) {
    if (!hasHistory)
        forget();
    else if (!context.lastRaster && isAgain(context, context.takenRows))
        stepBack();
    mTables = computeTables(context, instants);
    mInstantCount = instants.count;
    mHasHistory = hasHistory;
}

InstantMotions InstantMotionBuffers::declare(const render::PictureContext& context) {
    InstantMotions motions;
    const WrittenLayers written = writeInstantLayers(
        mDevice, mTables, {context.facts.width, context.facts.height}, mBuffers.at(context.slot)
    );
    motions.table = written.table;
    motions.mayHide = written.mayHide;
    motions.instantCount = mInstantCount;
    motions.hasLens = !mTables.lens.empty();
    motions.filtersLens = !context.view.lensTurn;
    motions.hasLast = mTables.last.has_value();
    motions.deforms = {
        mTables.raster.deforms,
        mTables.last && mTables.last->deforms,
        mTables.second && mTables.second->deforms};
    motions.mayCrowd = mayCrowdTiles(mTables);
    motions.drawWays = declareWays(context);
    if (const render::OtherRasterView* const second = context.secondRaster)
        motions.second = SecondRaster{
            second->gbuffer.color,
            second->gbuffer.motionDepth,
            second->gbuffer.entityId,
            second->gbuffer.edgeSurface.isValid()};
    if (const render::OtherRasterView* const last = context.lastRaster)
        motions.lent = LentRaster{
            last->gbuffer.color,
            last->gbuffer.motionDepth,
            last->gbuffer.entityId,
            last->gbuffer.edgeSurface.isValid()};
    if (!mHasHistory)
        return motions;
    motions.history = &mHistory;
    motions.keepsRaster = context.facts.isFollowed;
    if (!motions.keepsRaster)
        return motions;
    mBefore = std::move(mLast);
    mLast = std::move(mTables.record);
    return motions;
}

DrawWays InstantMotionBuffers::declareWays(const render::PictureContext& context) {
    if (mTables.rasterWays.empty() && mTables.lastWays.empty() && mTables.secondWays.empty())
        return {};
    auto& ways = mWays.at(context.slot);
    if (!ways)
        ways.emplace(mDevice);
    const render::ShapedFrame now{&context.frame, &context.shapes};
    std::array<render::ShapeWayLayer, 3> layers;
    layers[size_t(LayerIndex::Raster)] = {mTables.rasterWays, now};
    if (const render::OtherRasterView* const last = context.lastRaster)
        layers[size_t(LayerIndex::Last)] = {mTables.lastWays, {last->frame, &last->shapes}};
    else
        layers[size_t(LayerIndex::Last)] = {mTables.lastWays, {}, mLast ? &*mLast : nullptr};
    if (const render::OtherRasterView* const second = context.secondRaster)
        layers[size_t(LayerIndex::Second)] = {mTables.secondWays, {second->frame, &second->shapes}};
    ways->declareShapes(context.graph, now, mTables.middles, layers, mScene);
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
