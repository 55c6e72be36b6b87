// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/ray_mask.h"

#include "spirv/motion_blur/edge.comp.h"
#include "spirv/motion_blur/edge_view.comp.h"
#include "spirv/motion_blur/mask.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

#include <array>

namespace shutter::motion_blur {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describeEdge() {
    gpu::ComputePipelineDesc desc = describePass(
        "edge", motion_blur_edge_comp, {kSampled, kSampled, kSampled, kStorage, kStorage, kBuffer}
    );
    desc.specialization = {shader::kCandidateList};
    return desc;
}

gpu::ComputePipelineDesc describeEdgeView(bool everywhere) {
    gpu::ComputePipelineDesc desc = describePass(
        "edge view", motion_blur_edge_view_comp, {kSampled, kSampled, kSampled, kStorage}
    );
    desc.specialization = {everywhere ? 1u : 0u};
    return desc;
}

gpu::ComputePipelineDesc describeMask(MaskListing listing) {
    gpu::ComputePipelineDesc desc = describePass(
        "ray mask",
        motion_blur_mask_comp,
        {kSampled,
         kSampled,
         kSampled,
         kStorage,
         kBuffer,
         kBuffer,
         kBuffer,
         kBuffer,
         kBuffer,
         kBuffer,
         kBuffer,
         kSampled}
    );
    desc.specialization = {shader::kCandidateList, listing == MaskListing::BlockByBlock ? 1u : 0u};
    return desc;
}

graph::BufferHandle createArguments(graph::Graph& graph, const char* name, uint32_t count) {
    return graph.createBuffer(name, {sizeof(shader::DispatchArguments) * count, kArgumentsUsage});
}

/// What starts empty: pictures of 0, lists of nothing.
struct Cleared {
    std::array<graph::ImageHandle, 3> images; ///< edges, blocks with edges, mask
    graph::BufferHandle list;
    graph::BufferHandle arguments;
    graph::BufferHandle tiles;
    graph::BufferHandle tileArguments;
};

Cleared createCleared(graph::Graph& graph, const PassParams& params) {
    const glm::uvec2 size = params.sizePx;
    const glm::uvec2 blocks = countBlocks(params);
    const VkDeviceSize pixelCount = VkDeviceSize(size.x) * size.y;
    const VkDeviceSize tileCount = VkDeviceSize(params.tileCount.x) * params.tileCount.y;
    return {
        {graph.createImage("edges", {size.x, size.y, VK_FORMAT_R8_UNORM}),
         graph.createImage("edge blocks", {blocks.x, blocks.y, VK_FORMAT_R8_UNORM}),
         graph.createImage("ray mask", {size.x, size.y, VK_FORMAT_R8_UNORM})},
        graph.createBuffer(
            "masked pixels",
            {sizeof(shader::MaskHeader) + pixelCount * sizeof(uint32_t), kListUsage}
        ),
        createArguments(graph, "reveal arguments", 1),
        graph.createBuffer(
            "masked tiles",
            {sizeof(shader::TileHeader) + 2 * tileCount * sizeof(uint32_t), kListUsage}
        ),
        createArguments(graph, "masked tile arguments", 2)};
}

Cleared addClear(graph::Graph& graph, const PassParams& params) {
    return graph.addPass<Cleared>(
        "clear ray mask",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Cleared& data) {
            data = createCleared(graph, params);
            for (graph::ImageHandle& image : data.images)
                image = builder.write(image, Access::TransferWrite);
            for (graph::BufferHandle* buffer :
                 {&data.list, &data.arguments, &data.tiles, &data.tileArguments})
                *buffer = builder.write(*buffer, Access::TransferWrite);
        },
        [](const Cleared& data, graph::PassContext& context) {
            const VkClearColorValue zero{};
            const VkImageSubresourceRange whole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            for (graph::ImageHandle image : data.images)
                vkCmdClearColorImage(
                    context.commands,
                    context.resources.image(image).handle(),
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                    &zero,
                    1,
                    &whole
                );
            const shader::MaskHeader header{};
            clearList(context, data.list, &header, sizeof(header));
            const shader::DispatchArguments reveal{0, 0, 1};
            clearList(context, data.arguments, &reveal, sizeof(reveal));
            vkCmdFillBuffer(
                context.commands, context.resources.buffer(data.tiles), 0, VK_WHOLE_SIZE, 0
            );
            clearArguments(context, data.tileArguments, 2);
        }
    );
}

} // namespace

RayMask::RayMask(gpu::Device& device)
    : RayMask(device, isSoftware(device) ? MaskListing::PixelByPixel : MaskListing::BlockByBlock) {}

RayMask::RayMask(gpu::Device& device, MaskListing listing)
    : mSampler(device.nearestSampler()), mEdge(device, describeEdge()),
      mEdgeView(device, describeEdgeView(false)),
      mEdgeViewEverywhere(device, describeEdgeView(true)), mMask(device, describeMask(listing)) {}

graph::ImageHandle RayMask::addEdgeView(
    graph::Graph& graph, const RayMaskInputs& inputs, const PassParams& params
) const {
    struct Data {
        std::array<graph::ImageHandle, 3> in;
        graph::ImageHandle edge;
    };

    const gpu::LazyPipeline& pipeline = inputs.measureEverywhere ? mEdgeViewEverywhere : mEdgeView;
    const Data& pass = graph.addPass<Data>(
        "edge view",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.in = {inputs.motionDepth, inputs.normal, inputs.entityId};
            for (graph::ImageHandle image : data.in)
                builder.read(image, Access::SampledCompute);
            data.edge = builder.write(
                graph.createImage(
                    "edge", {params.sizePx.x, params.sizePx.y, VK_FORMAT_R8G8B8A8_UNORM}
                ),
                Access::StorageWrite
            );
        },
        [this, params, &pipeline](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            for (graph::ImageHandle image : data.in)
                bindings.sampled(context.resources.view(image), mSampler);
            bindings.storage(context.resources.image(data.edge));
            dispatchPixels(context, pipeline.get(), bindings, params, params.sizePx);
        }
    );
    return pass.edge;
}

RayMask::Edges RayMask::addEdges(
    graph::Graph& graph, const RayMaskInputs& inputs, const Edges& cleared, const PassParams& params
) const {
    struct Data {
        std::array<graph::ImageHandle, 3> in;
        BlockLists candidates;
        Edges out;
    };

    const Data& pass = graph.addPass<Data>(
        "edge",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.in = {inputs.motionDepth, inputs.normal, inputs.entityId};
            for (graph::ImageHandle image : data.in)
                builder.read(image, Access::SampledCompute);
            data.candidates = inputs.blocks.candidates;
            builder.read(data.candidates.blocks, Access::StorageRead);
            builder.read(data.candidates.arguments, Access::IndirectRead);
            data.out.edges = builder.write(cleared.edges, Access::StorageWrite);
            data.out.blocks = builder.write(cleared.blocks, Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            for (graph::ImageHandle image : data.in)
                bindings.sampled(resources.view(image), mSampler);
            bindings.storage(resources.image(data.out.edges))
                .storage(resources.image(data.out.blocks))
                .buffer(resources.buffer(data.candidates.blocks));
            dispatchList(
                context,
                mEdge.get(),
                bindings,
                params,
                data.candidates.arguments,
                shader::kCandidateList
            );
        }
    );
    return pass.out;
}

RayMaskOutputs
RayMask::add(graph::Graph& graph, const RayMaskInputs& inputs, const PassParams& params) const {
    const Cleared cleared = addClear(graph, params);
    const Edges edges = addEdges(graph, inputs, {cleared.images[0], cleared.images[1]}, params);

    struct Data {
        graph::ImageHandle motionDepth;
        graph::ImageHandle entityId;
        Edges edges;
        RayMaskOutputs out;
    };

    const Data& pass = graph.addPass<Data>(
        "ray mask",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.motionDepth = builder.read(inputs.motionDepth, Access::SampledCompute);
            data.entityId = builder.read(inputs.entityId, Access::SampledCompute);
            data.edges = edges;
            builder.read(edges.edges, Access::SampledCompute);
            builder.read(edges.blocks, Access::SampledCompute);
            data.out.mask = builder.write(cleared.images[2], Access::StorageWrite);
            data.out.list = builder.write(cleared.list, Access::StorageWrite);
            data.out.arguments = builder.write(cleared.arguments, Access::StorageWrite);
            const SortedBlocks& blocks = inputs.blocks;
            data.out.blocks.lists = {
                builder.write(blocks.lists.blocks, Access::StorageWrite),
                builder.write(blocks.lists.arguments, Access::StorageWrite)};
            data.out.blocks.candidates = {
                builder.write(blocks.candidates.blocks, Access::StorageWrite),
                builder.read(blocks.candidates.arguments, Access::IndirectRead)};
            data.out.tiles = builder.write(cleared.tiles, Access::StorageWrite);
            data.out.tileArguments = builder.write(cleared.tileArguments, Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            bindings.sampled(resources.view(data.motionDepth), mSampler)
                .sampled(resources.view(data.edges.edges), mSampler)
                .sampled(resources.view(data.edges.blocks), mSampler)
                .storage(resources.image(data.out.mask))
                .buffer(resources.buffer(data.out.blocks.candidates.blocks))
                .buffer(resources.buffer(data.out.list))
                .buffer(resources.buffer(data.out.arguments))
                .buffer(resources.buffer(data.out.blocks.lists.blocks))
                .buffer(resources.buffer(data.out.blocks.lists.arguments))
                .buffer(resources.buffer(data.out.tiles))
                .buffer(resources.buffer(data.out.tileArguments))
                .sampled(resources.view(data.entityId), mSampler);
            dispatchList(
                context,
                mMask.get(),
                bindings,
                params,
                data.out.blocks.candidates.arguments,
                shader::kCandidateList
            );
        }
    );
    RayMaskOutputs outputs = pass.out;
    outputs.edge = addEdgeView(graph, inputs, params);
    return outputs;
}

} // namespace shutter::motion_blur
