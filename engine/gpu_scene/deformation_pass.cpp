// SPDX-License-Identifier: MIT
#include "engine/gpu_scene/deformation_pass.h"

#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"

namespace shutter::gpu_scene {

namespace {

/// How much the arrays of a frame hold.
struct Sizes {
    uint64_t vertices = 0;  ///< at the raster instant
    uint64_t positions = 0; ///< at open and close together
};

Sizes measure(const extract::ExtractedFrame& frame, const extract::SceneLayout& layout) {
    Sizes sizes;
    for (const extract::DeformedEntity& entity : frame.deformed)
        for (uint32_t geometry = layout.firstGeometry[entity.mesh];
             geometry < layout.firstGeometry[entity.mesh + 1];
             ++geometry) {
            const uint64_t count = layout.geometries[geometry].vertexCount;
            sizes.vertices += count;
            sizes.positions += entity.changes ? 2 * count : 0;
        }
    return sizes;
}

} // namespace

DeformJobs DeformationPass::plan(
    const extract::ExtractedFrame& frame, const GpuScene& scene, std::vector<shader::Geometry>& rows
) {
    const extract::SceneLayout& layout = scene.layout();
    PoseTable poses;
    std::vector<PoseTable::Place> raster;
    std::vector<PoseTable::Place> ends; ///< of open; close follows
    for (const extract::DeformedEntity& entity : frame.deformed) {
        raster.push_back(poses.add(entity.raster));
        ends.push_back(entity.changes ? poses.add(entity.open) : PoseTable::Place{});
        if (entity.changes)
            (void)poses.add(entity.close);
    }
    poses.upload(mDevice, mPoses);

    DeformJobs jobs;
    VkDeviceAddress vertices = mShapes.address();
    VkDeviceAddress positions = vertices + measure(frame, layout).vertices * sizeof(shader::Vertex);
    for (size_t i = 0; i < frame.deformed.size(); ++i) {
        const extract::DeformedEntity& entity = frame.deformed[i];
        for (uint32_t geometry = layout.firstGeometry[entity.mesh];
             geometry < layout.firstGeometry[entity.mesh + 1];
             ++geometry) {
            shader::Geometry& row = rows.emplace_back(scene.geometryRows()[geometry]);
            row.vertices = gpu::splitAddress(vertices);
            shader::DeformJob shape = poses.makeJob(scene, geometry, raster[i]);
            shape.output_ = row.vertices;
            jobs.add(shape, 1);
            vertices += uint64_t{row.vertexCount} * sizeof(shader::Vertex);
            if (!entity.changes)
                continue;
            row.openPositions = gpu::splitAddress(positions);
            shader::DeformJob both = poses.makeJob(scene, geometry, ends[i]);
            both.output_ = row.openPositions;
            both.positionsOnly = 1;
            jobs.add(both, 2);
            positions += uint64_t{row.vertexCount} * sizeof(math::vec4);
            row.closePositions = gpu::splitAddress(positions);
            positions += uint64_t{row.vertexCount} * sizeof(math::vec4);
        }
    }
    jobs.upload(mDevice, mJobs);
    return jobs;
}

DeformedMeshes DeformationPass::declare(
    graph::Graph& graph, const extract::ExtractedFrame& frame, const GpuScene& scene
) {
    DeformedMeshes shapes;
    if (frame.deformed.empty())
        return shapes;
    const Sizes sizes = measure(frame, scene.layout());
    const uint64_t bytes =
        sizes.vertices * sizeof(shader::Vertex) + sizes.positions * sizeof(math::vec4);
    if (!mShapes || mShapes.bytes() < bytes) {
        VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
        if (mDevice.hasRays())
            usage |= VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
        mShapes = gpu::Buffer(
            mDevice, "deformed meshes", bytes + bytes / 2, usage, gpu::MemoryUse::Device
        );
    }
    const shader::DeformBatch batch = plan(frame, scene, shapes.rows).batch();
    const auto imported = graph.importBuffer("deformed meshes", mShapes.handle(), bytes);

    struct Data {};

    graph.addPass<Data>(
        "deform meshes",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data&) {
            shapes.buffer = builder.write(imported, graph::Access::StorageWrite);
        },
        [this, batch](const Data&, graph::PassContext& context) {
            mDeformer.deform(context.commands, batch);
        }
    );
    return shapes;
}

} // namespace shutter::gpu_scene
