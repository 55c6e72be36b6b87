// SPDX-License-Identifier: MIT
#include "engine/render/shape_levels.h"

#include "engine/graph/execute.h"

#include <algorithm>
#include <utility>

namespace shutter::render {

gpu::BuildAction
ShapeLevels::choose(Built& built, const DeformedEntity& entity, ecs::Entity handle) const {
    if (built.entity != handle || built.mesh != entity.mesh) {
        built = {handle, entity.mesh, entity.raster, 0};
        return gpu::BuildAction::Build;
    }
    if (isSame(built.pose, entity.raster))
        return gpu::BuildAction::Keep;
    built.pose = entity.raster;
    built.refits = built.refits < kRefitsPerBuild ? built.refits + 1 : 0;
    return built.refits > 0 ? gpu::BuildAction::Refit : gpu::BuildAction::Build;
}

graph::BufferHandle ShapeLevels::declare(
    graph::Graph& graph,
    const ExtractedFrame& frame,
    const GpuScene& scene,
    const DeformedShapes& shapes
) {
    using graph::Access;
    mAddresses.assign(frame.deformed.size(), 0);
    mWasRebuilt = false;
    std::vector<gpu::BottomLevelDesc> levels;
    std::vector<size_t> owners; // of ExtractedFrame::deformed
    size_t row = 0;
    for (size_t i = 0; i < frame.deformed.size(); ++i) {
        gpu::BottomLevelDesc level;
        level.triangles = scene.describeTriangles(frame.deformed[i].mesh);
        uint64_t triangleCount = 0;
        for (gpu::TriangleGeometry& triangles : level.triangles) {
            triangles.vertices = joinAddress(shapes.rows[row++].vertices);
            triangleCount += triangles.triangleCount;
        }
        if (triangleCount == 0)
            continue;
        owners.push_back(i);
        levels.push_back(std::move(level));
    }
    if (levels.empty())
        return {};

    if (!mLevels.prepareBottomLevels(mDevice, std::move(levels), true))
        mBuilt.assign(owners.size(), {});
    std::vector<gpu::BuildAction> actions;
    for (size_t i = 0; i < owners.size(); ++i) {
        const DeformedEntity& entity = frame.deformed[owners[i]];
        actions.push_back(choose(mBuilt[i], entity, frame.entityHandles[entity.row]));
        mAddresses[owners[i]] = mLevels.address(i);
    }
    auto levelsBuffer = graph.importBuffer("levels of bent meshes", mLevels.buffer(), 0);
    if (std::all_of(actions.begin(), actions.end(), [](gpu::BuildAction action) {
            return action == gpu::BuildAction::Keep;
        }))
        return levelsBuffer;
    mWasRebuilt = true;

    struct Data {};

    graph.addPass<Data>(
        "build bent meshes",
        graph::PassKind::Build,
        [&](graph::PassBuilder& builder, Data&) {
            builder.read(shapes.buffer, Access::ShaderRead);
            levelsBuffer = builder.write(levelsBuffer, Access::AccelerationBuild);
        },
        [this, actions](const Data&, graph::PassContext& context) {
            mLevels.record(mDevice, context.commands, actions);
        }
    );
    return levelsBuffer;
}

} // namespace shutter::render
