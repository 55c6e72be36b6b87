// SPDX-License-Identifier: MIT
#include "modules/depth_of_field/lens_rays.h"

#include "spirv/depth_of_field/lens_rays.comp.h"

#include "engine/graph/execute.h"

namespace shutter::depth_of_field {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describeRays(VkDescriptorSetLayout sceneLayout, bool hasBlended) {
    gpu::ComputePipelineDesc desc;
    desc.name = hasBlended ? "lens rays through blended surfaces" : "lens rays";
    desc.spirv = depth_of_field_lens_rays_comp;
    desc.interface.bindings.assign(3, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    desc.interface.bindings.insert(
        desc.interface.bindings.end(),
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
         VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
         VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR,
         VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}
    );
    desc.interface.sceneLayout = sceneLayout;
    desc.interface.pushConstantBytes = sizeof(shader::LensFilterParams);
    desc.specialization = {hasBlended ? 1u : 0u};
    return desc;
}

void readScene(graph::PassBuilder& builder, const graph::RayScene& rays) {
    builder.read(rays.tlasBuffer, Access::AccelerationRead);
    for (const graph::BufferHandle level : {rays.movingTlasBuffer, rays.deformedBlasBuffer})
        if (level.isValid())
            builder.read(level, Access::AccelerationRead);
    if (rays.deformedBuffer.isValid())
        builder.read(rays.deformedBuffer, Access::ShaderRead);
    for (const graph::BufferHandle buffer : rays.shading)
        builder.read(buffer, Access::ShaderRead);
}

} // namespace

LensRays::LensRays(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
    : mDevice(device), mPipelines{
                           gpu::LazyPipeline(device, describeRays(sceneLayout, false)),
                           gpu::LazyPipeline(device, describeRays(sceneLayout, true))} {
    for (gpu::Buffer& counts : mCounts)
        counts = gpu::Buffer(
            device,
            "lens ray counts",
            sizeof(shader::LensRayCounts),
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Readback
        );
}

graph::BufferHandle LensRays::addClear(graph::Graph& graph, uint32_t slot) const {
    struct Data {
        graph::BufferHandle counts;
    };

    const gpu::Buffer& buffer = mCounts.at(slot);
    const auto counts = graph.importBuffer("lens ray counts", buffer.handle(), buffer.bytes());
    return graph
        .addPass<Data>(
            "clear lens ray counts",
            graph::PassKind::Transfer,
            [&](graph::PassBuilder& builder, Data& data) {
                data.counts = builder.write(counts, Access::TransferWrite);
            },
            [](const Data& data, graph::PassContext& context) {
                const VkBuffer target = context.resources.buffer(data.counts);
                vkCmdFillBuffer(context.commands, target, 0, VK_WHOLE_SIZE, 0);
            }
        )
        .counts;
}

LensRaysOutputs LensRays::add(
    graph::Graph& graph, const LensRaysInputs& inputs, const shader::LensFilterParams& params
) {
    struct Data {
        LensRaysInputs in;
        LensRaysOutputs out;
        graph::BufferHandle counts;
    };

    const graph::BufferHandle cleared = addClear(graph, inputs.slot);
    const graph::TransientImageDesc target{
        params.sizePx.x, params.sizePx.y, VK_FORMAT_R16G16B16A16_SFLOAT};
    const gpu::LazyPipeline& pipeline = mPipelines.at(inputs.rays.hasBlended ? 1 : 0);
    const Data& pass = graph.addPass<Data>(
        "lens rays",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.in = inputs;
            for (const graph::ImageHandle image : {inputs.color, inputs.motionDepth, inputs.reach})
                builder.read(image, Access::SampledCompute);
            readScene(builder, inputs.rays);
            data.out.near =
                builder.write(graph.createImage("near field", target), Access::StorageWrite);
            data.out.behind =
                builder.write(graph.createImage("behind near field", target), Access::StorageWrite);
            data.counts = builder.write(cleared, Access::StorageWrite);
        },
        [this, params, &pipeline](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            for (const graph::ImageHandle image :
                 {data.in.color, data.in.motionDepth, data.in.reach})
                bindings.sampled(resources.view(image), mDevice.nearestSampler());
            bindings.storage(resources.image(data.out.near))
                .storage(resources.image(data.out.behind))
                .accelerationStructure(data.in.rays.tlas)
                .buffer(resources.buffer(data.counts));
            context.frame.bind(
                pipeline.get(), bindings, &params, sizeof(params), data.in.rays.textures
            );
            const glm::uvec2 groups =
                (params.sizePx + shader::kLensGroup - 1u) / shader::kLensGroup;
            vkCmdDispatch(context.commands, groups.x, groups.y, 1);
        }
    );

    struct ReadData {
        graph::BufferHandle counts;
    };

    graph.addPass<ReadData>(
        "read lens ray counts",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, ReadData& data) {
            data.counts = builder.read(pass.counts, Access::HostRead);
            builder.sideEffect();
        },
        [](const ReadData&, graph::PassContext&) {}
    );
    return pass.out;
}

void LensRays::count(uint32_t slot, render::Counters& counters) const {
    const auto& counts = *static_cast<const shader::LensRayCounts*>(mCounts.at(slot).mapped());
    counters["pixels masked"] = counts.pixels;
    counters["rays traced"] = counts.rays;
}

} // namespace shutter::depth_of_field
