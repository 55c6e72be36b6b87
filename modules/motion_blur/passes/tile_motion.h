// SPDX-License-Identifier: MIT
// Dominant motion of each tile's neighbourhood (McGuire 2012, section 3.1: TileMax, NeighborMax).
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "shaders/motion_blur/motion_blur_shared.h"

#include <string>

namespace shutter::motion_blur {

struct TileMotionOutputs {
    graph::ImageHandle tiles;
    graph::ImageHandle dominant;
};

class TileMotion {
  public:
    explicit TileMotion(gpu::Device& device);

    /// The longest motion of each tile only.
    graph::ImageHandle addTileMax(
        graph::Graph& graph,
        graph::ImageHandle motionDepth,
        const shader::MotionBlurParams& params,
        const std::string& suffix
    ) const;

    /// \param suffix told apart in the graph's names, e.g. " of reveal"
    TileMotionOutputs
    add(graph::Graph& graph,
        graph::ImageHandle motionDepth,
        const shader::MotionBlurParams& params,
        const std::string& suffix) const;

  private:
    VkSampler mSampler;
    gpu::Pipeline mTileMax;
    gpu::Pipeline mNeighbourMax;
};

} // namespace shutter::motion_blur
