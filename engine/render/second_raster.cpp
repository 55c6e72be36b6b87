// SPDX-License-Identifier: MIT
#include "engine/render/second_raster.h"

#include "engine/render/shadow_maps.h"

#include <array>

namespace shutter::render {

SecondRaster::SecondRaster(gpu::Device& device)
    : mTables(device), mDeformation(device), mShadows(std::make_unique<ShadowMaps>(device)) {}

SecondRaster::~SecondRaster() = default;

double findOtherEnd(double rasterTime) {
    return rasterTime < 0.5 ? 1.0 : 0.0;
}

core::Status SecondRaster::extract(
    const scene::World& world, const extract::SceneLayout& layout, extract::ViewRequest view
) {
    view.instant = findOtherEnd(view.exposure.rasterTime);
    auto extracted = mExtractor.update(world, layout, view);
    if (!extracted)
        return extracted.error();
    mFrame = extracted.value();
    mView = view;
    // Lit as the frame's own raster: what moves casts the shadow of the whole exposure in both.
    mShadows->prepare(
        extract::planShadows(world, layout, view, *mFrame, /*keepsExposure=*/true), *mFrame
    );
    return {};
}

SecondRasterView SecondRaster::declare(
    graph::Graph& graph,
    const gpu_scene::GpuScene& scene,
    const GBufferPass& pass,
    const ShadowPipelines* shadows
) {
    const gpu_scene::DeformedMeshes shapes = mDeformation.declare(graph, *mFrame, scene);
    mTables.updateEntities(*mFrame);
    const FrameTables::Addresses tables = mTables.upload(*mFrame, mView, scene, shapes.rows);
    graph::BufferHandle shadowMaps;
    if (shadows != nullptr)
        shadowMaps =
            mShadows->declare(graph, *shadows, *mFrame, scene, shapes.buffer, tables.constants);
    const GBuffer gbuffer = pass.declare(
        graph,
        "second G-buffer",
        *mFrame,
        scene,
        std::array{shapes.buffer, shadowMaps},
        tables.constants
    );
    return {gbuffer, mFrame, shapes, *mView.instant};
}

} // namespace shutter::render
