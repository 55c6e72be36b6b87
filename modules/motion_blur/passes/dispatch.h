// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/execute.h"
#include "shaders/motion_blur/motion_blur_shared.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace shutter::motion_blur {

/// A compute pipeline of this module: every pass pushes MotionBlurParams.
[[nodiscard]] inline gpu::ComputePipelineDesc describePass(
    std::string name, std::span<const uint32_t> spirv, std::vector<VkDescriptorType> bindings
) {
    gpu::ComputePipelineDesc desc;
    desc.name = std::move(name);
    desc.spirv = spirv;
    desc.interface.bindings = std::move(bindings);
    desc.interface.pushConstantBytes = sizeof(shader::MotionBlurParams);
    return desc;
}

/// Binds and dispatches one thread a pixel of `extent`, kGroupSize x kGroupSize a group.
inline void dispatchPixels(
    graph::PassContext& context,
    const gpu::Pipeline& pipeline,
    const gpu::BindingList& bindings,
    const shader::MotionBlurParams& params,
    glm::uvec2 extent,
    VkDescriptorSet sceneSet = VK_NULL_HANDLE
) {
    context.frame.bind(pipeline, bindings, &params, sizeof(params), sceneSet);
    const glm::uvec2 groups = (extent + shader::kGroupSize - 1u) / shader::kGroupSize;
    vkCmdDispatch(context.commands, groups.x, groups.y, 1);
}

inline constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
inline constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
inline constexpr VkDescriptorType kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;

} // namespace shutter::motion_blur
