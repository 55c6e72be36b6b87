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

} // namespace

ClearedMask RayMask::create(graph::Graph& graph, const PassParams& params, Clears& clears) {
    const glm::uvec2 size = params.sizePx;
    const glm::uvec2 blocks = countBlocks(params);
    const VkDeviceSize tileCount = VkDeviceSize(params.tileCount.x) * params.tileCount.y;
    const ClearedMask created{
        graph.createImage("edges", {size.x, size.y, VK_FORMAT_R8_UNORM}),
        graph.createImage("edge blocks", {blocks.x, blocks.y, VK_FORMAT_R8_UNORM}),
        MaskedPixels::create(graph, params, clears),
        graph.createBuffer(
            "masked tiles",
            {sizeof(shader::TileHeader) + 2 * tileCount * sizeof(uint32_t), kListUsage}
        ),
        graph.createBuffer(
            "masked tile arguments", {2 * sizeof(shader::DispatchArguments), kArgumentsUsage}
        )};
    clears.add(created.edges);
    clears.add(created.edgeBlocks);
    clears.add(created.tiles, 0);
    clears.addArguments(created.tileArguments, 2);
    return created;
}

ClearedMask RayMask::getCleared(const ClearedMask& created, const Clears& clears) {
    return {
        clears.get(created.edges),
        clears.get(created.edgeBlocks),
        MaskedPixels::getCleared(created.masked, clears),
        clears.get(created.tiles),
        clears.get(created.tileArguments)};
}

RayMask::RayMask(gpu::Device& device) : RayMask(device, chooseMaskListing(device)) {}

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
            data.candidates = readList(builder, inputs.blocks.candidates);
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
    Clears clears;
    const ClearedMask created = create(graph, params, clears);
    clears.declare(graph);
    return add(graph, inputs, getCleared(created, clears), params);
}

RayMaskOutputs RayMask::add(
    graph::Graph& graph,
    const RayMaskInputs& inputs,
    const ClearedMask& empty,
    const PassParams& params
) const {
    const Edges edges = addEdges(graph, inputs, {empty.edges, empty.edgeBlocks}, params);

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
            data.out.masked.mask = builder.write(empty.masked.mask, Access::StorageWrite);
            data.out.masked.list = builder.write(empty.masked.list, Access::StorageWrite);
            data.out.masked.arguments = builder.write(empty.masked.arguments, Access::StorageWrite);
            data.out.blocks = writeMasked(builder, inputs.blocks);
            data.out.tiles = builder.write(empty.tiles, Access::StorageWrite);
            data.out.tileArguments = builder.write(empty.tileArguments, Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            bindings.sampled(resources.view(data.motionDepth), mSampler)
                .sampled(resources.view(data.edges.edges), mSampler)
                .sampled(resources.view(data.edges.blocks), mSampler)
                .storage(resources.image(data.out.masked.mask))
                .buffer(resources.buffer(data.out.blocks.candidates.blocks))
                .buffer(resources.buffer(data.out.masked.list))
                .buffer(resources.buffer(data.out.masked.arguments))
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
