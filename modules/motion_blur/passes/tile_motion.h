// SPDX-License-Identifier: MIT
// Dominant motion of each tile's neighbourhood (McGuire 2012, section 3.1: TileMax, NeighborMax),
// and what the neighbourhood asks of the filters (block_class.glsl).
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "shaders/motion_blur/motion_blur_shared.h"

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
    add(graph::Graph& graph, graph::ImageHandle motionDepth, const shader::MotionBlurParams& params
    ) const;

  private:
    TileMaxOutputs addTileMax(
        graph::Graph& graph, graph::ImageHandle motionDepth, const shader::MotionBlurParams& params
    ) const;

    VkSampler mSampler;
    gpu::Pipeline mTileMax;
    gpu::Pipeline mNeighbourMax;
};

} // namespace shutter::motion_blur
