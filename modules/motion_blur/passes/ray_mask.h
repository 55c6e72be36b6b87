// SPDX-License-Identifier: MIT
// Where a background is about to come into sight (Tan et al., "Ray Mask"): mesh id and depth one
// motion away, 5x5 Sobel edge, range check.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "shaders/motion_blur/motion_blur_shared.h"

namespace shutter::motion_blur {

struct RayMaskInputs {
    graph::ImageHandle motionDepth;
    graph::ImageHandle normal;
    graph::ImageHandle meshId;
    graph::ImageHandle dominant;
    bool measureEverywhere = false;
};

struct RayMaskOutputs {
    graph::ImageHandle edge;       ///< RGBA8: candidate, measure, edge
    graph::ImageHandle mask;       ///< R8
    graph::BufferHandle list;      ///< MaskHeader, then the masked pixels
    graph::BufferHandle arguments; ///< RevealArguments
};

class RayMask {
  public:
    explicit RayMask(gpu::Device& device);
    RayMaskOutputs
    add(graph::Graph& graph, const RayMaskInputs& inputs, const shader::MotionBlurParams& params
    ) const;

  private:
    VkSampler mSampler;
    gpu::Pipeline mEdge;
    gpu::Pipeline mEdgeEverywhere;
    gpu::Pipeline mMask;
};

} // namespace shutter::motion_blur
