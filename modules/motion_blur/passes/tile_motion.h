// SPDX-License-Identifier: MIT
// The tiles of a frame: dominant motion of each one's neighbourhood (McGuire 2012, section 3.1:
// TileMax, NeighborMax), what the neighbourhood demands of the filters (block_class.glsl), and how
// much directions vary in it (Guertin 2014).
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"

#include <cstdint>

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

/// Rows of threads of a group that goes over a tile, kTileColumns in each: one where a group is a
/// loop over threads (software devices), else as many as the device takes, 32 at most. A picture
/// has some 264 tiles, too few for a GPU: on an NVIDIA H200 32 rows take 0.025 ms at 1920x1080, 8
/// rows 0.040.
[[nodiscard]] uint32_t countTileRows(const gpu::Device& device);

class TileMotion {
  public:
    explicit TileMotion(gpu::Device& device);

    TileMotionOutputs
    add(graph::Graph& graph, graph::ImageHandle motionDepth, const PassParams& params) const;

  private:
    TileMaxOutputs
    addTileMax(graph::Graph& graph, graph::ImageHandle motionDepth, const PassParams& params) const;

    VkSampler mSampler;
    gpu::LazyPipeline mTileMax;
    gpu::LazyPipeline mNeighbourMax;
};

struct GuertinTilesOutputs {
    graph::ImageHandle dominant; ///< RG32F: longest motion among the neighbours that reach the tile
    graph::ImageHandle variance; ///< R32F, [0, 1]: how much directions around it differ
};

class GuertinTiles {
  public:
    explicit GuertinTiles(gpu::Device& device);

    /// \param tiles TileMotion's: the longest motion of each tile
    [[nodiscard]] GuertinTilesOutputs
    add(graph::Graph& graph, graph::ImageHandle tiles, const PassParams& params) const;

  private:
    VkSampler mSampler;
    gpu::LazyPipeline mPipeline;
};

} // namespace shutter::motion_blur
