// SPDX-License-Identifier: MIT
#include "engine/render/other_raster.h"

#include <algorithm>
#include <utility>

namespace shutter::render {

extract::ViewRequest makeViewOfOtherEnd(const extract::ViewRequest& view) {
    extract::ViewRequest other = view;
    other.instant = view.exposure.rasterTime < 0.5 ? 1.0 : 0.0;
    return other;
}

core::Status OtherRaster::extract(
    const scene::World& world,
    const extract::SceneLayout& layout,
    const extract::ViewRequest& view,
    const Shared& shared
) {
    auto extracted = mExtractor.update(world, layout, view);
    if (!extracted)
        return extracted.error();
    mFrame = extracted.value();
    mTaken.clear();
    const std::span<const ecs::Entity> taken = shared.taken;
    if (!taken.empty())
        for (uint32_t row = 0; row < mFrame->entityHandles.size(); ++row)
            if (std::find(taken.begin(), taken.end(), mFrame->entityHandles[row]) != taken.end())
                mTaken.push_back(row);
    mView = view;
    mKind = shared.kind;
    mSlot = shared.slot;
    auto shading = extractShading(
        shared.shading, {world, layout, view, mExtractor.view(), *mFrame, shared.kind, shared.slot}
    );
    if (!shading)
        return shading.error();
    mShading = std::move(shading).value();
    return {};
}

OtherRasterView OtherRaster::declare(
    graph::Graph& graph,
    const char* name,
    const gpu_scene::GpuScene& scene,
    GBufferPass& pass,
    bool keepsEdges,
    const math::vec2& confusion
) {
    const gpu_scene::DeformedMeshes shapes = mDeformation.declare(graph, *mFrame, scene);
    mTables.entities().update(*mFrame);
    const FrameTables::Addresses tables = mTables.upload(
        *mFrame, mView, scene, {.taken = mTaken, .deformed = shapes.rows, .slots = mShading.slots}
    );
    std::vector<graph::BufferHandle> reads{shapes.buffer};
    for (const RasterShading::Running& one : mShading.running)
        reads.push_back(
            one.feature->declare({graph, *mFrame, shapes.buffer, tables.constants, mKind, mSlot})
        );
    const GBuffer gbuffer = pass.declare(
        graph,
        name,
        {*mFrame,
         scene,
         mTaken,
         reads,
         tables.constants,
         listSlots(mShading.slots),
         mView.samplesEdges,
         keepsEdges,
         /*writesNormals=*/false,
         confusion}
    );
    return {gbuffer, mFrame, shapes, &mView};
}

} // namespace shutter::render
