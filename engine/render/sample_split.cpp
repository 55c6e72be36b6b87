// SPDX-License-Identifier: MIT
#include "engine/render/sample_split.h"

#include "spirv/render/split_edges.comp.h"
#include "spirv/render/split_samples.comp.h"

#include "engine/gpu/frame.h"
#include "engine/graph/execute.h"
#include "shaders/render/split_samples_shared.h"

#include <array>
#include <span>

namespace shutter::render {

namespace {

using graph::Access;

/// Both shaders read the three images of samples and write those of a G-buffer.
gpu::ComputePipelineDesc describePipeline(const char* name, std::span<const uint32_t> spirv) {
    gpu::ComputePipelineDesc desc;
    desc.name = name;
    desc.spirv = spirv;
    desc.interface.bindings.assign(3, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    desc.interface.bindings.resize(7, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    desc.interface.pushConstantBytes = sizeof(shader::SplitParams);
    return desc;
}

gpu::ComputePipelineDesc describeSplit() {
    gpu::ComputePipelineDesc desc = describePipeline("split samples", render_split_samples_comp);
    desc.interface.bindings.resize(9, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    return desc;
}

gpu::ComputePipelineDesc describeEdges() {
    gpu::ComputePipelineDesc desc = describePipeline("split edges", render_split_edges_comp);
    desc.interface.bindings.push_back(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    desc.interface.bindings.push_back(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    return desc;
}

/// Pixels whose samples differ.
struct EdgeList {
    graph::BufferHandle arguments; ///< of the dispatch over them
    graph::BufferHandle pixels;    ///< their number, then each
};

EdgeList declareList(graph::Graph& graph, const math::uvec2& sizePx) {
    const VkDeviceSize pixels = VkDeviceSize{sizePx.x} * sizePx.y;
    return graph.addPass<EdgeList>(
        "clear edges",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, EdgeList& data) {
            const auto create = [&](const char* name, VkDeviceSize words) {
                return builder.write(
                    graph.createBuffer(name, {words * sizeof(uint32_t)}), Access::TransferWrite
                );
            };
            data.arguments = create("edge groups", 3);
            data.pixels = create("edge pixels", pixels + 1);
        },
        [](const EdgeList& data, graph::PassContext& context) {
            const std::array<uint32_t, 3> noGroups{0, 0, 1};
            const VkBuffer arguments = context.resources.buffer(data.arguments);
            vkCmdUpdateBuffer(context.commands, arguments, 0, sizeof(noGroups), noGroups.data());
            vkCmdFillBuffer(
                context.commands, context.resources.buffer(data.pixels), 0, sizeof(uint32_t), 0
            );
        }
    );
}

struct Data {
    SampleSplit::Samples samples;
    GBuffer split;
    EdgeList edges;
};

void readSamples(graph::PassBuilder& builder, const SampleSplit::Samples& samples) {
    for (const graph::ImageHandle image : {samples.color, samples.surface, samples.normal})
        if (image.isValid())
            builder.read(image, Access::SampledCompute);
}

gpu::BindingList
bindBoth(const gpu::Device& device, const graph::PassResources& resources, const Data& data) {
    gpu::BindingList bindings;
    SampleSplit::Samples from = data.samples;
    GBuffer to = data.split;
    if (!from.normal.isValid()) { // any images of the bindings' kinds: they are not used
        from.normal = from.surface;
        to.normal = to.color;
    }
    for (const graph::ImageHandle image : {from.color, from.surface, from.normal})
        bindings.sampled(resources.view(image), device.nearestSampler());
    for (const graph::ImageHandle image : {to.color, to.normal, to.motionDepth, to.entityId})
        bindings.storage(resources.image(image));
    return bindings;
}

} // namespace

SampleSplit::SampleSplit(gpu::Device& device)
    : mDevice(device), mSplit(device, describeSplit()), mEdges(device, describeEdges()) {}

GBuffer
SampleSplit::declare(graph::Graph& graph, const Samples& samples, const Request& request) const {
    const graph::TransientImageDesc size = graph.describeImage(samples.color);
    const shader::SplitParams params{
        {size.width, size.height},
        request.keepsEdges ? 1u : 0u,
        request.hasBlended ? 1u : 0u,
        samples.normal.isValid() ? 1u : 0u,
        request.confusion};
    const EdgeList list = declareList(graph, params.sizePx);
    const Data& whole = graph.addPass<Data>(
        "split samples",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            const auto create = [&](const char* name, VkFormat format) {
                return builder.write(
                    graph.createImage(name, {size.width, size.height, format}), Access::StorageWrite
                );
            };
            readSamples(builder, samples);
            data.samples = samples;
            data.split.color = create("color", kColorFormat);
            if (samples.normal.isValid())
                data.split.normal = create("normal", kNormalFormat);
            data.split.motionDepth = create("motion depth", kMotionDepthFormat);
            data.split.entityId = create("entity id", kEntityIdFormat);
            data.edges = {
                builder.write(list.arguments, Access::StorageWrite),
                builder.write(list.pixels, Access::StorageWrite)};
        },
        [this, params](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings = bindBoth(mDevice, resources, data);
            bindings.buffer(resources.buffer(data.edges.arguments))
                .buffer(resources.buffer(data.edges.pixels));
            context.frame.bind(mSplit.get(), bindings, &params, sizeof(params));
            vkCmdDispatch(
                context.commands, (params.sizePx.x + 7) / 8, (params.sizePx.y + 7) / 8, 1
            );
        }
    );
    GBuffer result =
        graph
            .addPass<Data>(
                "split edges",
                graph::PassKind::Compute,
                [&](graph::PassBuilder& builder, Data& data) {
                    readSamples(builder, samples);
                    data.samples = samples;
                    data.split = whole.split;
                    for (graph::ImageHandle* image :
                         {&data.split.color,
                          &data.split.normal,
                          &data.split.motionDepth,
                          &data.split.entityId})
                        if (image->isValid())
                            *image = builder.write(*image, Access::StorageWrite);
                    data.split.edgeSurface = builder.write(
                        graph.createImage(
                            "edge surface", {size.width, size.height, kEdgeSurfaceFormat}
                        ),
                        Access::StorageWrite
                    );
                    data.edges = {
                        builder.read(whole.edges.arguments, Access::IndirectRead),
                        builder.read(whole.edges.pixels, Access::StorageRead)};
                },
                [this, params](const Data& data, graph::PassContext& context) {
                    const graph::PassResources& resources = context.resources;
                    gpu::BindingList bindings = bindBoth(mDevice, resources, data);
                    bindings.storage(resources.image(data.split.edgeSurface))
                        .buffer(resources.buffer(data.edges.pixels));
                    context.frame.bind(mEdges.get(), bindings, &params, sizeof(params));
                    vkCmdDispatchIndirect(
                        context.commands, resources.buffer(data.edges.arguments), 0
                    );
                }
            )
            .split;
    if (!request.keepsEdges)
        result.edgeSurface = {};
    return result;
}

} // namespace shutter::render
