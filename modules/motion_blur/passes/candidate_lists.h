// SPDX-License-Identifier: MIT
// Which entities of a layer each tile of the picture may see during the exposure.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/clears.h"
#include "modules/motion_blur/passes/crowds.h"
#include "shaders/motion_blur/resolved_shared.h"

#include <array>

namespace shutter::motion_blur {

/// Tiles of a layer in which something deforms.
struct DeformingTiles {
    graph::BufferHandle tiles;     ///< shader::DeformingHeader, then the tiles
    graph::BufferHandle arguments; ///< shader::DispatchArguments: a group for each
};

/// Handles of a frame.
struct CandidateInputs {
    graph::ImageHandle surface; ///< of the layer
    /// MotionBlurInputs::edgeSurface, of this frame's raster; invalid: pixels show one surface.
    graph::ImageHandle edgeSurface;
    graph::BufferHandle empty; ///< of CandidateLists::create(), cleared
    DeformingTiles deforming;  ///< of createDeforming(), cleared; invalid: nothing deforms
    CrowdBuffers crowds;       ///< of all layers
};

struct CandidateOutputs {
    graph::BufferHandle candidates; ///< shader::TileCandidates[tile], not sorted
    DeformingTiles deforming;       ///< invalid: nothing deforms
    CrowdBuffers crowds;
};

/// Tiles that have a list, across and down.
[[nodiscard]] inline glm::uvec2 countCandidateTiles(const PassParams& params) {
    return (params.sizePx + shader::kCandidateTilePx - 1u) / shader::kCandidateTilePx;
}

class CandidateLists {
  public:
    explicit CandidateLists(gpu::Device& device);

    /// The lists of a layer, which nothing has written, to be cleared with others.
    [[nodiscard]] static graph::BufferHandle
    create(graph::Graph& graph, const PassParams& params, Clears& clears);

    /// The same for tiles in which something deforms.
    [[nodiscard]] static DeformingTiles
    createDeforming(graph::Graph& graph, const PassParams& params, Clears& clears);

    /// \param params with shader::ResolvedParams
    CandidateOutputs
    add(graph::Graph& graph,
        const CandidateInputs& inputs,
        LayerIndex layer,
        const PassParams& params) const;

  private:
    VkSampler mSampler;
    std::array<gpu::LazyPipeline, 3> mPipelines; ///< by layer
    gpu::LazyPipeline mWithEdges;                ///< of this frame's raster
};

} // namespace shutter::motion_blur
