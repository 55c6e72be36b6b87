// SPDX-License-Identifier: MIT
// Which entities of a layer each tile of the picture may see during the exposure.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"

namespace shutter::motion_blur {

enum class LayerIndex : uint8_t { Raster, Last };

/// Handles of a frame: the passes of both layers count into one.
struct CandidateInputs {
    graph::ImageHandle surface;     ///< of the layer
    graph::ImageHandle motionDepth; ///< of this frame's raster
    graph::BufferHandle counters;   ///< shader::ResolvedCounters
};

struct CandidateOutputs {
    graph::BufferHandle candidates; ///< shader::Candidate[tile][kCandidatesPerTile]
    graph::BufferHandle counters;
};

class CandidateLists {
  public:
    explicit CandidateLists(gpu::Device& device);

    /// \param params with shader::ResolvedParams
    CandidateOutputs
    add(graph::Graph& graph,
        const CandidateInputs& inputs,
        LayerIndex layer,
        const PassParams& params) const;

  private:
    VkSampler mSampler;
    gpu::LazyPipeline mRaster;
    gpu::LazyPipeline mLast;
};

} // namespace shutter::motion_blur
