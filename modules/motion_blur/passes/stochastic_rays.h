// SPDX-License-Identifier: MIT
// The scene seen by rays that each have their own time of the exposure (Cook et al. 1984).
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "engine/graph/ray_scene.h"
#include "modules/motion_blur/params.h"

namespace shutter::motion_blur {

struct StochasticRaysOutputs {
    graph::ImageHandle color;       ///< RGBA16F: mean of the rays; a: deviation of its luminance
    graph::ImageHandle motionDepth; ///< RGBA32F: of the surface that moves most in the pixel
};

class StochasticRays {
  public:
    StochasticRays(gpu::Device& device, VkDescriptorSetLayout sceneLayout);

    /// Traces params.sampleCount rays per pixel; `params` needs the addresses of `rays`.
    [[nodiscard]] StochasticRaysOutputs
    add(graph::Graph& graph, const graph::TimedRays& rays, const PassParams& params) const;

  private:
    gpu::LazyPipeline mPipeline;
};

} // namespace shutter::motion_blur
