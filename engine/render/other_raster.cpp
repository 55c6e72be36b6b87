// SPDX-License-Identifier: MIT
#include "engine/render/other_raster.h"

#include "engine/render/shadow_maps.h"

#include <algorithm>
#include <array>

namespace shutter::render {

extract::ViewRequest makeViewOfOtherEnd(const extract::ViewRequest& view) {
    extract::ViewRequest other = view;
    other.instant = view.exposure.rasterTime < 0.5 ? 1.0 : 0.0;
    return other;
}

OtherRaster::OtherRaster(gpu::Device& device)
    : mTables(device), mDeformation(device), mShadows(std::make_unique<ShadowMaps>(device)) {}

OtherRaster::~OtherRaster() = default;

core::Status OtherRaster::extract(
    const scene::World& world,
    const extract::SceneLayout& layout,
    const extract::ViewRequest& view,
    std::span<const ecs::Entity> layer
) {
    auto extracted = mExtractor.update(world, layout, view);
    if (!extracted)
        return extracted.error();
    mFrame = extracted.value();
    mTaken.clear();
    if (!layer.empty())
        for (uint32_t row = 0; row < mFrame->entityHandles.size(); ++row)
            if (std::find(layer.begin(), layer.end(), mFrame->entityHandles[row]) != layer.end())
                mTaken.push_back(row);
    mView = view;
    return mShadows->prepare(extract::planShadows(
        world, layout, view, mExtractor.view(), *mFrame, /*keepsExposure=*/true
    ));
}

OtherRasterView OtherRaster::declare(
    graph::Graph& graph,
    const char* name,
    const gpu_scene::GpuScene& scene,
    GBufferPass& pass,
    const ShadowPipelines* shadows,
    bool keepsEdges,
    const math::vec2& confusion
) {
    const gpu_scene::DeformedMeshes shapes = mDeformation.declare(graph, *mFrame, scene);
    mTables.entities().update(*mFrame);
    const FrameTables::Addresses tables = mTables.upload(
        *mFrame,
        mView,
        scene,
        {.taken = mTaken, .deformed = shapes.rows, .shadows = mShadows->constants()}
    );
    graph::BufferHandle shadowMaps;
    if (shadows != nullptr)
        shadowMaps =
            mShadows->declare(graph, *shadows, *mFrame, scene, shapes.buffer, tables.constants);
    const std::array reads{shapes.buffer, shadowMaps};
    const GBuffer gbuffer = pass.declare(
        graph,
        name,
        {*mFrame,
         scene,
         mTaken,
         reads,
         tables.constants,
         mShadows->constants() != 0,
         mView.samplesEdges,
         keepsEdges,
         /*writesNormals=*/false,
         confusion}
    );
    return {gbuffer, mFrame, shapes, &mView};
}

} // namespace shutter::render
