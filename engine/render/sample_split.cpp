// SPDX-License-Identifier: MIT
#include "engine/render/sample_split.h"

#include "spirv/render/split_samples.comp.h"

#include "engine/gpu/frame.h"
#include "engine/graph/execute.h"
#include "shaders/render/split_samples_shared.h"

namespace shutter::render {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describePipeline() {
    gpu::ComputePipelineDesc desc;
    desc.name = "split samples";
    desc.spirv = render_split_samples_comp;
    desc.interface.bindings.assign(4, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    desc.interface.bindings.resize(9, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    desc.interface.pushConstantBytes = sizeof(shader::SplitParams);
    return desc;
}

struct Data {
    GBuffer samples;
    GBuffer split;
};

} // namespace

SampleSplit::SampleSplit(gpu::Device& device)
    : mDevice(device), mPipeline(device, describePipeline()) {}

GBuffer SampleSplit::declare(
    graph::Graph& graph, const GBuffer& samples, bool keepsEdges, bool hasBlended
) const {
    const graph::TransientImageDesc size = graph.describeImage(samples.color);
    const shader::SplitParams params{
        {size.width, size.height}, keepsEdges ? 1u : 0u, hasBlended ? 1u : 0u};
    GBuffer result =
        graph
            .addPass<Data>(
                "split samples",
                graph::PassKind::Compute,
                [&](graph::PassBuilder& builder, Data& data) {
                    const auto create = [&](const char* name, VkFormat format) {
                        return builder.write(
                            graph.createImage(name, {size.width, size.height, format}),
                            Access::StorageWrite
                        );
                    };
                    for (const graph::ImageHandle image :
                         {samples.color, samples.normal, samples.motionDepth, samples.entityId})
                        builder.read(image, Access::SampledCompute);
                    data.samples = samples;
                    data.split.color = create("color", kColorFormat);
                    data.split.normal = create("normal", kNormalFormat);
                    data.split.motionDepth = create("motion depth", kMotionDepthFormat);
                    data.split.entityId = create("entity id", kEntityIdFormat);
                    data.split.edgeSurface = create("edge surface", kEdgeSurfaceFormat);
                },
                [this, params](const Data& data, graph::PassContext& context) {
                    const graph::PassResources& resources = context.resources;
                    const GBuffer& drawn = data.samples;
                    const GBuffer& split = data.split;
                    gpu::BindingList bindings;
                    for (const graph::ImageHandle image :
                         {drawn.color, drawn.normal, drawn.motionDepth, drawn.entityId})
                        bindings.sampled(resources.view(image), mDevice.nearestSampler());
                    for (const graph::ImageHandle image :
                         {split.color,
                          split.normal,
                          split.motionDepth,
                          split.entityId,
                          split.edgeSurface})
                        bindings.storage(resources.image(image));
                    context.frame.bind(mPipeline.get(), bindings, &params, sizeof(params));
                    vkCmdDispatch(
                        context.commands, (params.sizePx.x + 7) / 8, (params.sizePx.y + 7) / 8, 1
                    );
                }
            )
            .split;
    if (!keepsEdges)
        result.edgeSurface = {};
    return result;
}

} // namespace shutter::render
