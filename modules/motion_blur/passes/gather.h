// SPDX-License-Identifier: MIT
// The gather of one or two layers and their composite (Tan et al., "Post-process" and appendix).
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "shaders/motion_blur/motion_blur_shared.h"

#include <optional>

namespace shutter::motion_blur {

/// What lies behind, where the mask says so.
struct RevealedLayer {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle dominant;
    graph::ImageHandle mask;
};

struct GatherInputs {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle dominant;
    std::optional<RevealedLayer> reveal; ///< none: the raster layer alone
};

class Gather {
  public:
    explicit Gather(gpu::Device& device);
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph, const GatherInputs& inputs, const shader::MotionBlurParams& params
    ) const;

  private:
    VkSampler mSampler;
    gpu::Pipeline mOneLayer;
    gpu::Pipeline mTwoLayers;
};

} // namespace shutter::motion_blur
