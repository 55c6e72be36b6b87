// SPDX-License-Identifier: MIT
#include "engine/render/second_raster.h"

namespace shutter::render {

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
    return {};
}

SecondRasterView SecondRaster::declare(
    graph::Graph& graph, const gpu_scene::GpuScene& scene, const GBufferPass& pass
) {
    const gpu_scene::DeformedMeshes shapes = mDeformation.declare(graph, *mFrame, scene);
    mTables.updateEntities(*mFrame);
    const FrameTables::Addresses tables = mTables.upload(*mFrame, mView, scene, shapes.rows);
    const GBuffer gbuffer =
        pass.declare(graph, "second G-buffer", *mFrame, scene, shapes.buffer, tables.constants);
    return {gbuffer, mFrame, *mView.instant};
}

} // namespace shutter::render
