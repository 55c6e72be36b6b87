// SPDX-License-Identifier: MIT
// The background behind masked pixels (Tan et al., "Recursive Ray Tracing").
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "shaders/motion_blur/motion_blur_shared.h"

#include <optional>

namespace shutter::motion_blur {

/// What rays meet, in the terms of shaders/render/: another engine fills the same tables.
struct RayInputs {
    graph::BufferHandle topLevelBuffer;                   ///< read with Access::AccelerationRead
    graph::BufferHandle shapeLevelsBuffer; ///< likewise, unless it is invalid: nothing is bent
    graph::BufferHandle shapesBuffer;      ///< read with Access::ShaderRead, unless it is invalid
    VkAccelerationStructureKHR topLevel = VK_NULL_HANDLE; ///< custom index: row of the entity table
    VkDescriptorSet scene = VK_NULL_HANDLE;               ///< set 1: bindless textures
    glm::uvec2 frame{0u};                                 ///< address of FrameConstants
    bool hasBlended = false; ///< blended surfaces lie over what is revealed, as over the raster's
};

struct RayRevealInputs {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle meshId;
    graph::BufferHandle list;      ///< of RayMask
    graph::BufferHandle arguments; ///< of RayMask
    RayInputs rays;
};

struct RayRevealOutputs {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle meshId;
};

class RayReveal {
  public:
    RayReveal(gpu::Device& device, VkDescriptorSetLayout sceneLayout);
    RayRevealOutputs
    add(graph::Graph& graph, const RayRevealInputs& inputs, const shader::MotionBlurParams& params);

    /// What the last frame counted; valid once the GPU is done with it.
    [[nodiscard]] shader::MaskHeader lastHeader() const;

  private:
    RayRevealOutputs copyLayer(graph::Graph& graph, const RayRevealInputs& inputs) const;
    const gpu::Pipeline& findPipeline(bool hasBlended);

    gpu::Device& mDevice;
    VkDescriptorSetLayout mSceneLayout;
    VkSampler mSampler;
    gpu::Pipeline mReveal;
    std::optional<gpu::Pipeline> mRevealBlended; ///< made for the first frame that needs it
    gpu::Buffer mHeader;
};

} // namespace shutter::motion_blur
