// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/execute.h"
#include "modules/motion_blur/params.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace shutter::motion_blur {

/// A compute pipeline of this module: every pass pushes PassParams.
[[nodiscard]] inline gpu::ComputePipelineDesc describePass(
    std::string name, std::span<const uint32_t> spirv, std::vector<VkDescriptorType> bindings
) {
    gpu::ComputePipelineDesc desc;
    desc.name = std::move(name);
    desc.spirv = spirv;
    desc.interface.bindings = std::move(bindings);
    desc.interface.pushConstantBytes = sizeof(PassParams);
    return desc;
}

/// Subgroup size of passes with divergent pixels: small subgroups wait less, and compilers use more
/// registers. AMD's GPUs also have twice this size.
inline constexpr uint32_t kDivergingSubgroup = 32;

/// Whether shaders run on the CPU, where fewer threads that do more each are faster.
[[nodiscard]] inline bool isSoftware(const gpu::Device& device) {
    return device.info().kind == "software";
}

/// Binds and dispatches one thread a pixel of `extent`, kGroupSize x kGroupSize a group.
inline void dispatchPixels(
    graph::PassContext& context,
    const gpu::Pipeline& pipeline,
    const gpu::BindingList& bindings,
    const PassParams& params,
    glm::uvec2 extent,
    VkDescriptorSet sceneSet = VK_NULL_HANDLE
) {
    context.frame.bind(pipeline, bindings, &params, sizeof(params), sceneSet);
    const glm::uvec2 groups = (extent + shader::kGroupSize - 1u) / shader::kGroupSize;
    vkCmdDispatch(context.commands, groups.x, groups.y, 1);
}

/// Binds and dispatches over a list, whose arguments are the `list`th of a buffer of
/// shader::DispatchArguments.
inline void dispatchList(
    graph::PassContext& context,
    const gpu::Pipeline& pipeline,
    const gpu::BindingList& bindings,
    const PassParams& params,
    graph::BufferHandle arguments,
    uint32_t list
) {
    context.frame.bind(pipeline, bindings, &params, sizeof(params));
    vkCmdDispatchIndirect(
        context.commands,
        context.resources.buffer(arguments),
        list * sizeof(shader::DispatchArguments)
    );
}

/// Blocks of a picture, across and down.
[[nodiscard]] inline glm::uvec2 countBlocks(const PassParams& params) {
    return (params.sizePx + shader::kGroupSize - 1u) / shader::kGroupSize;
}

/// In a transfer pass: copies an image to one of the same size and format.
inline void copyWhole(graph::PassContext& context, graph::ImageHandle from, graph::ImageHandle to) {
    const gpu::Image& source = context.resources.image(from);
    VkImageCopy region{};
    region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.dstSubresource = region.srcSubresource;
    region.extent = {source.desc().width, source.desc().height, 1};
    vkCmdCopyImage(
        context.commands,
        source.handle(),
        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
        context.resources.image(to).handle(),
        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        1,
        &region
    );
}

/// In a transfer pass: writes the head of a list.
inline void
clearList(graph::PassContext& context, graph::BufferHandle list, const void* header, size_t bytes) {
    vkCmdUpdateBuffer(context.commands, context.resources.buffer(list), 0, bytes, header);
}

/// In a transfer pass: dispatches of no groups, for kListCount lists at most.
inline void
clearArguments(graph::PassContext& context, graph::BufferHandle arguments, uint32_t listCount) {
    std::array<shader::DispatchArguments, shader::kListCount> none;
    none.fill({0, 0, 1});
    vkCmdUpdateBuffer(
        context.commands,
        context.resources.buffer(arguments),
        0,
        listCount * sizeof(shader::DispatchArguments),
        none.data()
    );
}

inline constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
inline constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
inline constexpr VkDescriptorType kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;

inline constexpr VkBufferUsageFlags kListUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
inline constexpr VkBufferUsageFlags kArgumentsUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

} // namespace shutter::motion_blur
