// SPDX-License-Identifier: MIT
// Which entities of a layer each tile of the picture may see during the exposure.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/clears.h"
#include "shaders/motion_blur/resolved_shared.h"

#include <array>

namespace shutter::motion_blur {

/// As kRasterLayer and the others in resolved.glsl.
enum class LayerIndex : uint8_t { Raster, Last, Second };

/// Handles of a frame: the passes of all layers count into one.
struct CandidateInputs {
    graph::ImageHandle surface;     ///< of the layer
    graph::ImageHandle motionDepth; ///< of this frame's raster
    graph::BufferHandle counters;   ///< shader::ResolvedCounters
    graph::BufferHandle empty;      ///< of CandidateLists::create(), cleared
};

struct CandidateOutputs {
    graph::BufferHandle candidates; ///< shader::TileCandidates[tile], not sorted
    graph::BufferHandle counters;
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

    /// \param params with shader::ResolvedParams
    CandidateOutputs
    add(graph::Graph& graph,
        const CandidateInputs& inputs,
        LayerIndex layer,
        const PassParams& params) const;

  private:
    VkSampler mSampler;
    std::array<gpu::LazyPipeline, 3> mPipelines; ///< by layer
};

} // namespace shutter::motion_blur
