// SPDX-License-Identifier: MIT
#include "engine/rays/tlas.h"

#include "engine/graph/execute.h"

#include <utility>

namespace shutter::rays {

namespace {

/// Calls `use` with each row that is static.
template <class Use> void forEachStill(const extract::ExtractedFrame& frame, Use&& use) {
    size_t next = 0; // of movingRows
    for (uint32_t row = 0; row < frame.entities.size(); ++row) {
        if (next < frame.movingRows.size() && frame.movingRows[next] == row)
            ++next;
        else
            use(row);
    }
}

bool addStill(const MaskedFrame& masked, uint32_t row, InstanceList& instances) {
    const extract::ExtractedFrame& frame = masked.frame;
    return instances.add(
        row,
        frame.entityMeshes[row],
        frame.entities[row].relWorldFromObject,
        extract::solidMaskOf(masked.masks, row)
    );
}

} // namespace

TlasHandles FrameTlas::declare(
    graph::Graph& graph,
    const MaskedFrame& masked,
    const gpu_scene::GpuScene& scene,
    const gpu_scene::DeformedMeshes& shapes
) {
    const extract::ExtractedFrame& frame = masked.frame;
    TlasHandles handles;
    handles.deformedBuffer = mDeformedBlas.declare(graph, frame, scene, shapes);
    mDeformedBlasBuffer = handles.deformedBuffer;
    // Kept from frame to frame: an allocation may have the allocator clean up behind all the draws
    // that the driver recorded, for milliseconds.
    if (!mMovingInstances)
        mMovingInstances.emplace(scene);
    InstanceList& moving = *mMovingInstances;
    moving.clear();
    listMoving(masked, moving);
    const bool apart = frame.entities.size() - frame.movingRows.size() >= kStaticTlasInstances;
    bool build = false;
    if (apart) {
        build = updateStill(masked, scene);
        if (!moving.instances().empty()) {
            const bool buildMoving = update(mMoving, moving, false);
            handles.movingBuffer = declareOne(graph, "TLAS of movers", mMoving, buildMoving);
            handles.movingTlas = mMoving.level.structure().address();
        }
    } else {
        mMoving.listed.clear();
        const bool wasApart = std::exchange(mStillRevision, 0) != 0;
        forEachStill(frame, [&](uint32_t row) { (void)addStill(masked, row, moving); });
        build = update(mStill, moving, wasApart);
    }
    handles.buffer = declareOne(graph, "TLAS", mStill, build);
    handles.level = mStill.level.structure().handle();
    return handles;
}

void FrameTlas::listMoving(const MaskedFrame& masked, InstanceList& instances) const {
    const extract::ExtractedFrame& frame = masked.frame;
    size_t nextDeformed = 0;
    for (const uint32_t row : frame.movingRows) {
        const auto& relWorldFromObject = frame.entities[row].relWorldFromObject;
        const uint32_t solidMask = extract::solidMaskOf(masked.masks, row);
        if (nextDeformed == frame.deformed.size() || frame.deformed[nextDeformed].row != row) {
            instances.add(row, frame.entityMeshes[row], relWorldFromObject, solidMask);
            continue;
        }
        const extract::DeformedEntity& deformed = frame.deformed[nextDeformed];
        const VkDeviceAddress level = mDeformedBlas.address(nextDeformed++);
        instances.add(
            DeformedInstance{row, deformed.mesh, deformed.mirrored, level, deformed.bounds},
            relWorldFromObject,
            solidMask
        );
    }
}

void FrameTlas::orderStill(const MaskedFrame& masked, const gpu_scene::GpuScene& scene) {
    InstanceList instances(scene);
    std::vector<uint32_t> listed;
    std::vector<uint32_t> leftOut; // may be met from another place of the camera
    forEachStill(masked.frame, [&](uint32_t row) {
        (addStill(masked, row, instances) ? listed : leftOut).push_back(row);
    });
    mStillOrder.clear();
    for (const uint32_t index : instances.computeOrder())
        mStillOrder.push_back(listed[index]);
    mStillOrder.insert(mStillOrder.end(), leftOut.begin(), leftOut.end());
    mStillSet = masked.frame.staticSet;
}

bool FrameTlas::updateStill(const MaskedFrame& masked, const gpu_scene::GpuScene& scene) {
    const extract::ExtractedFrame& frame = masked.frame;
    // While the camera moves, the masks of static entities depend on the other entities.
    if (mStillRevision == frame.staticRevision && frame.staticMotions.empty())
        return false;
    if (mStillSet != frame.staticSet)
        orderStill(masked, scene);
    InstanceList instances(scene);
    for (const uint32_t row : mStillOrder)
        (void)addStill(masked, row, instances);
    mStill.level.prepare(mDevice, instances.instances());
    mStill.listed.clear(); // not as update() lists
    mStillRevision = frame.staticRevision;
    return true;
}

bool FrameTlas::update(Level& level, const InstanceList& instances, bool force) {
    // A level holds the bounds of those below it.
    if (!force && level.level.structure() && !mDeformedBlas.wasRebuilt() &&
        level.listed == instances.instances())
        return false;
    level.level.prepare(mDevice, instances.order());
    level.listed = instances.instances();
    return true;
}

graph::BufferHandle
FrameTlas::declareOne(graph::Graph& graph, const char* name, const Level& level, bool build) const {
    auto buffer = graph.importBuffer(name, level.level.structure().buffer(), 0);
    if (!build)
        return buffer;

    struct Data {};

    graph.addPass<Data>(
        fmt::format("build {}", name),
        graph::PassKind::Build,
        [&](graph::PassBuilder& builder, Data&) {
            if (mDeformedBlasBuffer.isValid())
                builder.read(mDeformedBlasBuffer, graph::Access::AccelerationRead);
            buffer = builder.write(buffer, graph::Access::AccelerationBuild);
        },
        [this, &level](const Data&, graph::PassContext& context) {
            level.level.record(mDevice, context.commands);
        }
    );
    return buffer;
}

} // namespace shutter::rays
