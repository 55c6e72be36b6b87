// SPDX-License-Identifier: MIT
// The scene for rays that each have their own time. What stands still are instances of triangles as
// ever. What moves is a box over its whole way; a ray that meets the box goes, with the entity's
// placement at the ray's own time, into object space and on through the mesh's own structure. No
// time is quantised, and nothing is rebuilt for another time.
#pragma once

#include "engine/gpu/acceleration_structure.h"
#include "engine/graph/graph.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/moving_shapes.h"
#include "engine/render/moving_tables.h"
#include "engine/render/post_effect.h"

#include <cstdint>
#include <vector>

namespace shutter::render {

class MovingScene {
  public:
    explicit MovingScene(gpu::Device& device) : mDevice(device), mShapes(device) {}

    /// Bends what bends; to be called before declare(). The GPU must be done with the last frame's.
    /// \return rows for the frame's geometry table, to stand one behind the other
    [[nodiscard]] const std::vector<shader::Geometry>&
    prepareShapes(const MovingTables& tables, const GpuScene& scene);

    /// Uploads the tables and declares the builds. The GPU must be done with the last frame's.
    /// \param tables computed with `frame`
    /// \param firstShapeGeometry where the rows of prepareShapes() stand in the geometry table
    [[nodiscard]] MovingRays declare(
        graph::Graph& graph,
        const MovingTables& tables,
        const ExtractedFrame& frame,
        GpuScene& scene,
        uint32_t firstShapeGeometry,
        VkDeviceAddress frameConstants
    );

  private:
    [[nodiscard]] std::vector<shader::MovingRow> makeRows(
        const MovingTables& tables,
        const ExtractedFrame& frame,
        const GpuScene& scene,
        uint32_t firstShapeGeometry
    ) const;
    VkDeviceAddress upload(const MovingTables& tables, std::vector<shader::MovingRow> rows);
    [[nodiscard]] std::vector<gpu::Instance>
    listInstances(const MovingTables& tables, const ExtractedFrame& frame, const GpuScene& scene);
    void declareBuilds(graph::Graph& graph, bool anyMoves, MovingRays& rays);

    gpu::Device& mDevice;
    gpu::Buffer mTables; ///< constants, rows, keys, lights of the frame, mapped
    MovingShapes mShapes;
    gpu::BoxLevel mBoxes;
    gpu::TopLevel mTopLevel;
};

} // namespace shutter::render
