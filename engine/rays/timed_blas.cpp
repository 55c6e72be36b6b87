// SPDX-License-Identifier: MIT
#include "engine/rays/timed_blas.h"

#include "engine/extract/deformed_entity.h"
#include "engine/gpu/upload.h"
#include "engine/gpu/vulkan.h"
#include "engine/rays/instances.h"

#include <algorithm>

namespace shutter::rays {

namespace {

bool isSameShape(const extract::TimedDeformation& a, const extract::TimedDeformation& b) {
    return a.mesh == b.mesh && a.mirrored == b.mirrored &&
           std::equal(a.keys.begin(), a.keys.end(), b.keys.begin(), b.keys.end(), extract::isSame);
}

uint32_t countTriangles(const extract::SceneLayout& layout, uint32_t mesh) {
    uint32_t count = 0;
    for (uint32_t g = layout.firstGeometry[mesh]; g < layout.firstGeometry[mesh + 1]; ++g)
        count += layout.geometries[g].indexCount / 3;
    return count;
}

uint64_t countVertices(const extract::SceneLayout& layout, uint32_t mesh) {
    uint64_t count = 0;
    for (uint32_t g = layout.firstGeometry[mesh]; g < layout.firstGeometry[mesh + 1]; ++g)
        count += layout.geometries[g].vertexCount;
    return count;
}

} // namespace

/// Everything to record once.
struct TimedBlas::Work {
    struct Deform {
        shader::DeformJob job;
        uint32_t keyCount;
    };

    struct Bound {
        shader::DeformedBoxJob job;
        uint32_t intervalCount;
    };

    gpu_scene::PoseTable poses;
    std::vector<gpu_scene::PoseTable::Place> places; ///< one per shape, of its first key
    std::vector<Deform> deforms;
    std::vector<Bound> bounds;
    std::vector<gpu::BlasDesc> levels;
    VkDeviceAddress nextVertex = 0;
    VkDeviceAddress nextBox = 0;
};

void TimedBlas::planOne(
    const extract::TimedDeformation& shape,
    size_t index,
    const gpu_scene::GpuScene& scene,
    Work& work
) const {
    const extract::SceneLayout& layout = scene.layout();
    const auto keyCount = static_cast<uint32_t>(shape.keys.size());
    const uint32_t triangles = countTriangles(layout, shape.mesh);
    const uint32_t intervals = triangles > 0 ? keyCount - 1 : 0;
    std::vector<gpu::BlasDesc> levels(shape.changes() ? intervals : triangles > 0);
    if (!shape.changes() && triangles > 0)
        levels[0].triangles = scene.describeTriangles(shape.mesh);
    const uint32_t first = layout.firstGeometry[shape.mesh];
    VkDeviceAddress boxes = work.nextBox;
    for (uint32_t g = first; g < layout.firstGeometry[shape.mesh + 1]; ++g) {
        const shader::Geometry& row = scene.geometryRows()[g];
        shader::DeformJob deform = work.poses.makeJob(scene, g, work.places[index]);
        deform.output_ = gpu::splitAddress(work.nextVertex);
        work.deforms.push_back({deform, keyCount});
        if (!levels.empty() && !shape.changes())
            levels[0].triangles[g - first].vertices = work.nextVertex;
        if (intervals > 0) {
            shader::DeformedBoxJob bound{};
            bound.vertices = deform.output_;
            bound.indices = row.indices;
            bound.boxes = gpu::splitAddress(boxes);
            bound.boxStride = triangles;
            bound.vertexCount = row.vertexCount;
            bound.triangleCount = row.indexCount / 3;
            work.bounds.push_back({bound, intervals});
            const uint64_t stride = uint64_t{triangles} * sizeof(gpu::BoxGeometry);
            for (uint32_t i = 0; i < intervals; ++i)
                levels[i].boxes.push_back({boxes + i * stride, bound.triangleCount});
            boxes += uint64_t{bound.triangleCount} * sizeof(gpu::BoxGeometry);
        }
        work.nextVertex += uint64_t{keyCount} * row.vertexCount * sizeof(shader::Vertex);
    }
    work.nextBox += uint64_t{intervals} * triangles * sizeof(gpu::BoxGeometry);
    for (gpu::BlasDesc& level : levels)
        work.levels.push_back(std::move(level));
}

TimedBlas::Work TimedBlas::plan(
    std::span<const extract::TimedDeformation> shapes, const gpu_scene::GpuScene& scene
) {
    const extract::SceneLayout& layout = scene.layout();
    Work work;
    uint64_t vertices = 0;
    uint64_t boxes = 0;
    for (const extract::TimedDeformation& shape : shapes) {
        work.places.push_back(work.poses.add(shape.keys.front()));
        for (size_t key = 1; key < shape.keys.size(); ++key)
            (void)work.poses.add(shape.keys[key]);
        vertices += shape.keys.size() * countVertices(layout, shape.mesh);
        boxes += (shape.keys.size() - 1) * countTriangles(layout, shape.mesh);
    }
    work.poses.upload(mDevice, mPoses);
    constexpr VkBufferUsageFlags kUsage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
        VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
    mVertices = gpu::Buffer(
        mDevice,
        "vertices at deformation keys",
        vertices * sizeof(shader::Vertex),
        kUsage,
        gpu::MemoryUse::Device
    );
    mBoxes = gpu::Buffer(
        mDevice,
        "boxes of deformed triangles",
        boxes * sizeof(gpu::BoxGeometry),
        kUsage,
        gpu::MemoryUse::Device
    );
    work.nextVertex = mVertices.address();
    work.nextBox = mBoxes.address();
    mRows.clear();
    mEntries.clear();
    mFirstBlas.clear();
    for (size_t i = 0; i < shapes.size(); ++i) {
        mEntries.push_back(
            {static_cast<uint32_t>(mRows.size()),
             static_cast<uint32_t>(shapes[i].keys.size()),
             0,
             0}
        );
        mFirstBlas.push_back(work.levels.size());
        const size_t firstDeformed = work.deforms.size();
        planOne(shapes[i], i, scene, work);
        for (size_t deform = firstDeformed; deform < work.deforms.size(); ++deform) {
            const uint32_t geometry = layout.firstGeometry[shapes[i].mesh] +
                                      static_cast<uint32_t>(deform - firstDeformed);
            mRows.push_back(scene.geometryRows()[geometry]);
            mRows.back().vertices = work.deforms[deform].job.output_;
        }
    }
    mFirstBlas.push_back(work.levels.size());
    return work;
}

void TimedBlas::linkScenes(
    std::span<const extract::TimedDeformation> shapes, const gpu_scene::GpuScene& scene
) {
    std::vector<gpu::Instance> instances;
    for (size_t i = 0; i < shapes.size(); ++i)
        for (size_t level = mFirstBlas[i]; level < mFirstBlas[i + 1]; ++level)
            instances.push_back(describeInstance(
                scene,
                DeformedInstance{
                    shapes[i].row,
                    shapes[i].mesh,
                    shapes[i].mirrored,
                    mBlases.address(level),
                    shapes[i].bounds}
            ));
    mScenes.prepareTlas(mDevice, instances);
    mAddresses = gpu::Buffer(
        mDevice,
        "TLAS of deformed meshes",
        mScenes.count() * sizeof(math::uvec2),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        gpu::MemoryUse::Stream
    );
    std::vector<math::uvec2> addresses;
    for (size_t level = 0; level < mScenes.count(); ++level)
        addresses.push_back(gpu::splitAddress(mScenes.address(level)));
    mAddresses.write(std::span<const math::uvec2>(addresses));
    for (size_t i = 0; i < shapes.size(); ++i) {
        const size_t first = mFirstBlas[i];
        if (first == mFirstBlas[i + 1])
            continue;
        Entry& entry = mEntries[i];
        entry.scene = mScenes.address(first);
        if (shapes[i].changes())
            entry.scene = mAddresses.address() + first * sizeof(math::uvec2);
        else
            entry.level = mBlases.address(first);
    }
}

void TimedBlas::update(
    std::span<const extract::TimedDeformation> shapes, const gpu_scene::GpuScene& scene
) {
    if (std::equal(shapes.begin(), shapes.end(), mShapes.begin(), mShapes.end(), isSameShape))
        return;
    mShapes.clear(); // until all of it is there: what fails must not be taken for kept
    if (shapes.empty()) {
        mRows.clear();
        mEntries.clear();
        return;
    }
    Work work = plan(shapes, scene);
    (void)mBlases.prepareBlas(mDevice, std::move(work.levels));
    linkScenes(shapes, scene);
    gpu_scene::DeformJobs jobs;
    for (const Work::Deform& deform : work.deforms)
        jobs.add(deform.job, deform.keyCount);
    gpu::Buffer jobTable;
    jobs.upload(mDevice, jobTable);
    gpu::runOnce(mDevice, [&](VkCommandBuffer commands) {
        mDeformer.deform(commands, jobs.batch());
        gpu::fullBarrier(commands);
        for (const Work::Bound& bound : work.bounds)
            mDeformer.boundTriangles(commands, bound.job, bound.intervalCount);
        gpu::fullBarrier(commands);
        mBlases.record(mDevice, commands);
        gpu::fullBarrier(commands);
        mScenes.record(mDevice, commands);
        gpu::fullBarrier(commands);
    });
    mShapes.assign(shapes.begin(), shapes.end());
}

} // namespace shutter::rays
