// SPDX-License-Identifier: MIT
// What `resolved` knows of tiles that see more entities than their lists hold.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/execute.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/clears.h"
#include "modules/motion_blur/passes/surface_layers.h"

namespace shutter::motion_blur {

/// Handles of a frame; invalid where no tile can be crowded.
struct CrowdBuffers {
    graph::BufferHandle tiles;     ///< shader::TileCrowd, by layer and tile
    graph::BufferHandle arguments; ///< of dispatches over all tiles; none unless a list overflows
};

/// The push constants with the address of the table, which is known once the frame is recorded.
[[nodiscard]] PassParams withCrowds(
    const PassParams& params, const graph::PassResources& resources, graph::BufferHandle tiles
);

class Crowds {
  public:
    explicit Crowds(gpu::Device& device);

    /// Creates unwritten buffers, to be cleared with others.
    /// \param params with shader::ResolvedParams, which contain the layers
    [[nodiscard]] static CrowdBuffers
    create(graph::Graph& graph, const PassParams& params, Clears& clears);

    /// Finds the motion of surfaces that pass over crowded tiles, and further crowded tiles. Does
    /// nothing where no list overflowed.
    /// \param crowds as the passes left them that listed candidates
    /// \param motionDepth of this frame's raster
    /// \return TileCrowd, complete
    [[nodiscard]] graph::BufferHandle
    add(graph::Graph& graph,
        const SurfaceLayersOutputs& layers,
        graph::ImageHandle motionDepth,
        const CrowdBuffers& crowds,
        const PassParams& params) const;

  private:
    VkSampler mSampler;
    gpu::LazyPipeline mPipeline;
};

} // namespace shutter::motion_blur
