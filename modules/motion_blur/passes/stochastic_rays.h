// SPDX-License-Identifier: MIT
// The scene seen by rays that each have their own time of the exposure (Cook et al. 1984).
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "shaders/motion_blur/motion_blur_shared.h"

namespace shutter::motion_blur {

/// What rays at any time meet, in the terms of shaders/render/timed_scene_shared.h.
struct TimedRayInputs {
    graph::BufferHandle tlasBuffer;     ///< read with Access::AccelerationRead
    graph::BufferHandle boxesBuffer;    ///< likewise, unless it is invalid: then nothing moves
    graph::BufferHandle deformedBuffer; ///< read with Access::ShaderRead, unless it is invalid
    VkAccelerationStructureKHR tlas = VK_NULL_HANDLE;
    VkDescriptorSet scene = VK_NULL_HANDLE; ///< set 1: bindless textures
    glm::uvec2 frame{0u};                   ///< address of FrameConstants
    glm::uvec2 moving{0u};                  ///< address of TimedConstants
};

struct StochasticRaysOutputs {
    graph::ImageHandle color;       ///< RGBA16F: mean of the rays; a: deviation of its luminance
    graph::ImageHandle motionDepth; ///< RGBA32F: of the surface that moves most in the pixel
};

class StochasticRays {
  public:
    StochasticRays(gpu::Device& device, VkDescriptorSetLayout sceneLayout);

    /// Traces params.sampleCount rays a pixel; `params` needs the addresses of `rays`.
    [[nodiscard]] StochasticRaysOutputs
    add(graph::Graph& graph, const TimedRayInputs& rays, const shader::MotionBlurParams& params
    ) const;

  private:
    gpu::Pipeline mPipeline;
};

} // namespace shutter::motion_blur
