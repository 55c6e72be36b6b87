// SPDX-License-Identifier: MIT
// Finds the samples of a block's pixels for all of them together: if they see one plane of this
// frame's raster, no search is needed.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/crowds.h"
#include "modules/motion_blur/passes/surface_layers.h"

#include <array>

namespace shutter::motion_blur {

/// Candidates of each tile, sorted.
struct SortedCandidates {
    graph::BufferHandle raster; ///< shader::TileCandidates[tile]
    graph::BufferHandle second; ///< invalid: there is no such layer
    graph::BufferHandle last;   ///< the same
};

/// Per-tile data of a frame.
struct TileInputs {
    SortedCandidates candidates;
    graph::BufferHandle parts; ///< of DeformingParts, this frame's raster; invalid: nothing deforms
    graph::BufferHandle crowds;   ///< shader::TileCrowd; invalid: no tile can be crowded
    graph::BufferHandle counters; ///< shader::ResolvedCounters
    bool isGeneral = false;       ///< InstantMotions::isGeneral()
};

struct BlockSampleOutputs {
    SortedBlocks blocks; ///< kUniformList, kMixedList; of general tiles: the candidates
    graph::BufferHandle counters;
    graph::BufferHandle blockSamples; ///< shader::BlockSample[block]: a head, then one per instant
                                      ///< of the tables; invalid: none is known
};

class BlockSamples {
  public:
    /// \param sortsUniform blocks that see a plane at every instant are in a separate list
    BlockSamples(gpu::Device& device, bool sortsUniform);

    /// Whether the number of instants and the size of the lookup buffer are within their limits.
    [[nodiscard]] bool canFind(const PassParams& params) const;

    /// Sorts the blocks that something moves in.
    /// \param raster this frame's
    /// \param empty BlockSorter::getCleared()
    /// \param params with shader::ResolvedParams; uniformMotionPx 0: each pixel searches for
    /// itself, as it must unless canFind()
    [[nodiscard]] BlockSampleOutputs addFind(
        graph::Graph& graph,
        const SurfaceLayer& raster,
        const TileInputs& tiles,
        const SortedBlocks& empty,
        const PassParams& params
    ) const;

    /// \param blockSamples of addFind()
    /// \return target with the uniform blocks written
    [[nodiscard]] graph::ImageHandle addResolve(
        graph::Graph& graph,
        const SurfaceLayer& raster,
        const SortedBlocks& blocks,
        graph::BufferHandle blockSamples,
        graph::ImageHandle target,
        const PassParams& params
    ) const;

  private:
    /// \return shader::BlockPlane[block]
    [[nodiscard]] graph::BufferHandle addFit(
        graph::Graph& graph,
        const SurfaceLayer& raster,
        const TileInputs& tiles,
        const PassParams& params
    ) const;

    gpu::Device& mDevice;
    gpu::LazyPipeline mFit;
    /// 1 added where something deforms, 2 with a lens.
    std::array<gpu::LazyPipeline, 4> mFind;
    std::array<gpu::LazyPipeline, 2> mResolve; ///< 1: with a lens
};

} // namespace shutter::motion_blur
