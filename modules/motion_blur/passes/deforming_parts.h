// SPDX-License-Identifier: MIT
// Deforming parts (resolved_parts_shared.h): found per tile, and listed in the tiles where they may
// be visible.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/candidate_lists.h"
#include "modules/motion_blur/passes/clears.h"

#include <array>

namespace shutter::motion_blur {

/// Handles of a layer's frame.
struct PartInputs {
    graph::ImageHandle surface; ///< of the layer
    graph::ImageHandle motion;  ///< RGBA32F, xy: of this frame's raster, open to close
    graph::ImageHandle ways;    ///< of the layer, as DrawWays draws them; invalid: `motion` counts
    DeformingTiles tiles;       ///< as CandidateLists left them
    CandidateOutputs listed;    ///< the layer's, which takes the parts
    graph::BufferHandle parts;  ///< of create()
};

struct PartOutputs {
    CandidateOutputs listed;
    graph::BufferHandle parts;
};

class DeformingParts {
  public:
    explicit DeformingParts(gpu::Device& device);

    /// shader::TilePart[tile][kPartsPerTile] of a layer, which nothing has written.
    [[nodiscard]] static graph::BufferHandle create(graph::Graph& graph, const PassParams& params);

    /// \param params with shader::ResolvedParams
    PartOutputs
    add(graph::Graph& graph, const PartInputs& inputs, LayerIndex layer, const PassParams& params
    ) const;

  private:
    VkSampler mSampler;
    std::array<gpu::LazyPipeline, 3> mPipelines; ///< by layer
};

} // namespace shutter::motion_blur
