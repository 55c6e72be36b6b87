// SPDX-License-Identifier: MIT
// Bright points out of focus, which a lens spreads over more pixels than there are samples: taken
// out of the layer, to be drawn as discs (lens_discs.h).
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/clears.h"
#include "modules/motion_blur/passes/surface_layers.h"

namespace shutter::motion_blur {

/// Invalid handles: no points are taken out.
struct BrightPointBuffers {
    graph::BufferHandle counts;    ///< shader::PointHeader, and the number of points by region
    graph::BufferHandle points;    ///< shader::BrightPoint, kMaxRegionPoints for each region
    graph::BufferHandle arguments; ///< of a dispatch over all blocks; of none without any point
    graph::BufferHandle regions;   ///< shader::RegionHeader, and indices of regions to search
    graph::BufferHandle search;    ///< arguments of a dispatch over these regions
};

struct BrightPointOutputs {
    graph::ImageHandle color; ///< the layer's, with the points replaced by what is around them
    BrightPointBuffers buffers;
};

class BrightPoints {
  public:
    explicit BrightPoints(gpu::Device& device);

    /// Creates unwritten buffers, to be cleared with others.
    [[nodiscard]] static BrightPointBuffers
    create(graph::Graph& graph, const PassParams& params, Clears& clears);

    /// The same after the clearing pass is declared.
    [[nodiscard]] static BrightPointBuffers
    getCleared(const BrightPointBuffers& made, const Clears& clears);

    /// \param color of this frame's raster, to be copied
    /// \param raster this frame's, of the same colour
    /// \param cleared of getCleared()
    /// \param params with shader::ResolvedParams of a frame with a lens
    [[nodiscard]] BrightPointOutputs
    add(graph::Graph& graph,
        graph::ImageHandle color,
        const SurfaceLayer& raster,
        const BrightPointBuffers& cleared,
        const PassParams& params) const;

  private:
    /// Lists the regions to search.
    [[nodiscard]] BrightPointBuffers addRegions(
        graph::Graph& graph,
        graph::ImageHandle color,
        const BrightPointBuffers& buffers,
        const PassParams& params
    ) const;

    VkSampler mSampler;
    gpu::LazyPipeline mRegions;
    gpu::LazyPipeline mPoints;
};

} // namespace shutter::motion_blur
