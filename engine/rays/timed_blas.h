// SPDX-License-Identifier: MIT
// Deformed meshes for time-sampled rays. A changing shape has its vertices at each key, and for
// each two adjacent keys a BLAS of boxes, one per triangle, around its linear motion from one key
// to the other: a ray that hits a box is tested against the triangle at the ray's time. An
// unchanging shape is an ordinary mesh.
#pragma once

#include "engine/extract/timed_tables.h"
#include "engine/gpu/structure_set.h"
#include "engine/gpu_scene/deformer.h"
#include "engine/gpu_scene/gpu_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::rays {

class TimedBlas {
  public:
    explicit TimedBlas(gpu::Device& device) : mDevice(device), mDeformer(device) {}

    /// The ray-tracing data of one shape.
    struct Entry {
        uint32_t firstRow = 0;     ///< index into rows()
        uint32_t keyCount = 1;     ///< shader::TimedRow::deformationKeyCount
        VkDeviceAddress level = 0; ///< its BLAS; 0: it changes, or has no triangles
        VkDeviceAddress scene = 0; ///< shader::TimedRow::meshScene; 0: it has no triangles
    };

    /// Deforms, builds and waits, unless the shapes are those of the last call. The GPU must have
    /// finished with those.
    void
    update(std::span<const extract::TimedDeformation> shapes, const gpu_scene::GpuScene& scene);

    /// Geometries of all shapes, shape after shape.
    [[nodiscard]] const std::vector<shader::Geometry>& rows() const { return mRows; }

    [[nodiscard]] const Entry& operator[](size_t shape) const { return mEntries[shape]; }

  private:
    struct Work;

    [[nodiscard]] Work
    plan(std::span<const extract::TimedDeformation> shapes, const gpu_scene::GpuScene& scene);
    void planOne(
        const extract::TimedDeformation& shape,
        size_t index,
        const gpu_scene::GpuScene& scene,
        Work& work
    ) const;
    void
    linkScenes(std::span<const extract::TimedDeformation> shapes, const gpu_scene::GpuScene& scene);

    gpu::Device& mDevice;
    gpu_scene::Deformer mDeformer;
    std::vector<extract::TimedDeformation> mShapes; ///< of the last call
    std::vector<shader::Geometry> mRows;
    std::vector<Entry> mEntries;
    std::vector<size_t> mFirstBlas; ///< one per shape, and one past the last: into mBlases
    gpu::Buffer mPoses;
    gpu::Buffer mVertices;
    gpu::Buffer mBoxes;
    gpu::Buffer mAddresses; ///< uvec2[]: scenes of the shapes that change
    gpu::StructureSet mBlases;
    gpu::StructureSet mScenes; ///< one per BLAS
};

} // namespace shutter::rays
