// SPDX-License-Identifier: MIT
// Dominant motion and its variance in each tile's neighbourhood (Guertin et al. 2014).
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"

namespace shutter::motion_blur {

struct GuertinTilesOutputs {
    graph::ImageHandle dominant; ///< RG32F: longest motion among the neighbours that reach the tile
    graph::ImageHandle variance; ///< R32F, [0, 1]: how much directions around it differ
};

class GuertinTiles {
  public:
    explicit GuertinTiles(gpu::Device& device);

    /// \param tiles TileMotion's: the longest motion of each tile
    [[nodiscard]] GuertinTilesOutputs
    add(graph::Graph& graph, graph::ImageHandle tiles, const PassParams& params
    ) const;

  private:
    VkSampler mSampler;
    gpu::LazyPipeline mPipeline;
};

} // namespace shutter::motion_blur
