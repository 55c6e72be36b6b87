// SPDX-License-Identifier: MIT
// Dominant motion of each tile's neighbourhood (McGuire 2012, section 3.1: TileMax, NeighborMax),
// and what the neighbourhood asks of the filters (block_class.glsl).
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"

namespace shutter::motion_blur {

struct TileMaxOutputs {
    graph::ImageHandle tiles;  ///< RG32F: longest motion
    graph::ImageHandle ranges; ///< RGBA32F: spread of the motions, nearest and farthest depth
};

struct TileMotionOutputs {
    graph::ImageHandle tiles;
    graph::ImageHandle dominant;  ///< RG32F: longest motion of the neighbourhood
    graph::ImageHandle tileClass; ///< R32F: kClassStill ...
};

class TileMotion {
  public:
    explicit TileMotion(gpu::Device& device);

    TileMotionOutputs
    add(graph::Graph& graph, graph::ImageHandle motionDepth, const PassParams& params
    ) const;

  private:
    TileMaxOutputs addTileMax(
        graph::Graph& graph, graph::ImageHandle motionDepth, const PassParams& params
    ) const;

    VkSampler mSampler;
    gpu::LazyPipeline mTileMax;
    gpu::LazyPipeline mNeighbourMax;
};

} // namespace shutter::motion_blur
