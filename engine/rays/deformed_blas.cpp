// SPDX-License-Identifier: MIT
#include "engine/rays/deformed_blas.h"

#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"

#include <algorithm>
#include <utility>

namespace shutter::rays {

gpu::BuildAction
DeformedBlas::choose(size_t index, const extract::DeformedEntity& entity, ecs::Entity handle) {
    Built& built = mBuilt[index];
    if (built.entity != handle || built.mesh != entity.mesh) {
        built = {handle, entity.mesh, entity.raster, RefitTurns(index)};
        return gpu::BuildAction::Build;
    }
    if (extract::isSame(built.pose, entity.raster))
        return gpu::BuildAction::Keep;
    built.pose = entity.raster;
    return built.turns.take();
}

graph::BufferHandle DeformedBlas::declare(
    graph::Graph& graph,
    const extract::ExtractedFrame& frame,
    const gpu_scene::GpuScene& scene,
    const gpu_scene::DeformedMeshes& shapes
) {
    using graph::Access;
    mAddresses.assign(frame.deformed.size(), 0);
    mWasRebuilt = false;
    std::vector<gpu::BlasDesc> blases;
    std::vector<size_t> owners; // of ExtractedFrame::deformed
    size_t row = 0;
    for (size_t i = 0; i < frame.deformed.size(); ++i) {
        gpu::BlasDesc blas;
        blas.triangles = scene.describeTriangles(frame.deformed[i].mesh);
        uint64_t triangleCount = 0;
        for (gpu::TriangleGeometry& triangles : blas.triangles) {
            triangles.vertices = gpu::joinAddress(shapes.rows[row++].vertices);
            triangleCount += triangles.triangleCount;
        }
        if (triangleCount == 0)
            continue;
        owners.push_back(i);
        blases.push_back(std::move(blas));
    }
    if (blases.empty())
        return {};

    if (!mBlases.prepareBlas(mDevice, std::move(blases), true))
        mBuilt.assign(owners.size(), {});
    std::vector<gpu::BuildAction> actions;
    for (size_t i = 0; i < owners.size(); ++i) {
        const extract::DeformedEntity& entity = frame.deformed[owners[i]];
        actions.push_back(choose(i, entity, frame.entityHandles[entity.row]));
        mAddresses[owners[i]] = mBlases.address(i);
    }
    auto blasBuffer = graph.importBuffer("BLAS of deformed meshes", mBlases.buffer(), 0);
    if (std::all_of(actions.begin(), actions.end(), [](gpu::BuildAction action) {
            return action == gpu::BuildAction::Keep;
        }))
        return blasBuffer;
    mWasRebuilt = true;

    struct Data {};

    graph.addPass<Data>(
        "build deformed meshes",
        graph::PassKind::Build,
        [&](graph::PassBuilder& builder, Data&) {
            builder.read(shapes.buffer, Access::ShaderRead);
            blasBuffer = builder.write(blasBuffer, Access::AccelerationBuild);
        },
        [this, actions](const Data&, graph::PassContext& context) {
            mBlases.record(mDevice, context.commands, actions);
        }
    );
    return blasBuffer;
}

} // namespace shutter::rays
