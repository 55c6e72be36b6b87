// SPDX-License-Identifier: MIT
#include "engine/render/longest_motion.h"

#include "spirv/render/longest_motion.comp.h"

#include "engine/gpu/frame.h"
#include "engine/graph/execute.h"
#include "shaders/render/longest_motion_shared.h"

#include <bit>

namespace shutter::render {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describePipeline() {
    gpu::ComputePipelineDesc desc;
    desc.name = "longest motion";
    desc.spirv = render_longest_motion_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    desc.interface.pushConstantBytes = sizeof(shader::LongestMotionParams);
    return desc;
}

graph::BufferHandle addClear(graph::Graph& graph, VkDeviceSize bytes) {
    const auto buffer =
        graph.createBuffer("longest motions", {bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});

    struct Data {
        graph::BufferHandle longest;
    };

    return graph
        .addPass<Data>(
            "clear longest motions",
            graph::PassKind::Transfer,
            [&](graph::PassBuilder& builder, Data& data) {
                data.longest = builder.write(buffer, Access::TransferWrite);
            },
            [](const Data& data, graph::PassContext& context) {
                const VkBuffer target = context.resources.buffer(data.longest);
                vkCmdFillBuffer(context.commands, target, 0, VK_WHOLE_SIZE, 0);
            }
        )
        .longest;
}

} // namespace

LongestMotion::LongestMotion(gpu::Device& device)
    : mDevice(device), mSampler(device.nearestSampler()), mPipeline(device, describePipeline()) {}

void LongestMotion::declare(PictureContext& context) {
    graph::Graph& graph = context.graph;
    mRowCount = static_cast<uint32_t>(context.frame.entities.size());
    const VkDeviceSize bytes = (VkDeviceSize(mRowCount) + 1) * sizeof(uint32_t);
    if (mResult.bytes() < bytes)
        mResult = gpu::Buffer(mDevice, "longest motions", 2 * bytes, 0, gpu::MemoryUse::Readback);

    struct Data {
        graph::ImageHandle motionDepth;
        graph::ImageHandle entityId;
        graph::BufferHandle longest;
    };

    const auto cleared = addClear(graph, bytes);
    const shader::LongestMotionParams params{
        {context.facts.width, context.facts.height}, mRowCount, 0};
    const Data& found = graph.addPass<Data>(
        "longest motion",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.motionDepth = builder.read(context.gbuffer.motionDepth, Access::SampledCompute);
            data.entityId = builder.read(context.gbuffer.entityId, Access::SampledCompute);
            data.longest = builder.write(cleared, Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& recording) {
            gpu::BindingList bindings;
            bindings.sampled(recording.resources.view(data.motionDepth), mSampler)
                .sampled(recording.resources.view(data.entityId), mSampler)
                .buffer(recording.resources.buffer(data.longest));
            recording.frame.bind(mPipeline.get(), bindings, &params, sizeof(params));
            const glm::uvec2 groups =
                (params.sizePx + shader::kLongestMotionGroup - 1u) / shader::kLongestMotionGroup;
            vkCmdDispatch(recording.commands, groups.x, groups.y, 1);
        }
    );

    struct CopyData {
        graph::BufferHandle from;
        graph::BufferHandle to;
    };

    const auto result = graph.importBuffer("motions found", mResult.handle(), mResult.bytes());
    graph.addPass<CopyData>(
        "read longest motions",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, CopyData& data) {
            data.from = builder.read(found.longest, Access::TransferRead);
            data.to = builder.write(result, Access::TransferWrite);
            graph.markOutput(data.to);
        },
        [bytes](const CopyData& data, graph::PassContext& recording) {
            const VkBufferCopy region{0, 0, bytes};
            vkCmdCopyBuffer(
                recording.commands,
                recording.resources.buffer(data.from),
                recording.resources.buffer(data.to),
                1,
                &region
            );
        }
    );
}

std::vector<float> LongestMotion::take() const {
    const auto* bits = static_cast<const uint32_t*>(mResult.mapped());
    std::vector<float> longest;
    for (uint32_t i = 0; i <= mRowCount; ++i)
        longest.push_back(std::bit_cast<float>(bits[i]));
    return longest;
}

} // namespace shutter::render
