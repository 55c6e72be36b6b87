// SPDX-License-Identifier: MIT
// The scene for time-sampled rays. Static entities are ordinary instances. A mover is a box around
// its whole motion; a ray that hits the box is transformed into object space, by the entity's
// placement at the ray's time, and traced through the mesh's BLAS. No time is quantised, and
// nothing is rebuilt for another time.
#pragma once

#include "engine/extract/timed_tables.h"
#include "engine/gpu/acceleration_structure.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/graph.h"
#include "engine/graph/ray_scene.h"
#include "engine/rays/timed_blas.h"

#include <cstdint>
#include <vector>

namespace shutter::rays {

class TimedScene {
  public:
    explicit TimedScene(gpu::Device& device) : mDevice(device), mShapes(device) {}

    /// Deforms meshes; must be called before declare(). The GPU must have finished the last
    /// frame's. \return consecutive rows for the frame's geometry table
    [[nodiscard]] const std::vector<shader::Geometry>&
    prepareDeformed(const extract::TimedTables& tables, const gpu_scene::GpuScene& scene);

    /// Uploads the tables and declares the builds. The GPU must have finished with the last
    /// frame's.
    /// \param tables computed with `frame`
    /// \param firstDeformedGeometry index of the first row of prepareDeformed() in the geometry
    /// table
    [[nodiscard]] graph::TimedRays declare(
        graph::Graph& graph,
        const extract::TimedTables& tables,
        const extract::ExtractedFrame& frame,
        gpu_scene::GpuScene& scene,
        uint32_t firstDeformedGeometry,
        VkDeviceAddress frameConstants
    );

  private:
    [[nodiscard]] std::vector<shader::TimedRow> makeRows(
        const extract::TimedTables& tables,
        const extract::ExtractedFrame& frame,
        const gpu_scene::GpuScene& scene,
        uint32_t firstDeformedGeometry
    ) const;
    VkDeviceAddress upload(const extract::TimedTables& tables, std::vector<shader::TimedRow> rows);
    [[nodiscard]] std::vector<gpu::Instance> listInstances(
        const extract::TimedTables& tables,
        const extract::ExtractedFrame& frame,
        const gpu_scene::GpuScene& scene
    );
    void declareBuilds(graph::Graph& graph, bool anyMoves, graph::TimedRays& rays);

    gpu::Device& mDevice;
    gpu::Buffer mTables; ///< constants, rows, keys, lights of the frame, mapped
    TimedBlas mShapes;
    gpu::BoxBlas mBoxes;
    gpu::Tlas mTlas;
};

} // namespace shutter::rays
