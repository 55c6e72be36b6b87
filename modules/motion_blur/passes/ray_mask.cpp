// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/ray_mask.h"

#include "spirv/motion_blur/edge.comp.h"
#include "spirv/motion_blur/mask.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

namespace {

gpu::ComputePipelineDesc describeEdge(bool everywhere) {
    gpu::ComputePipelineDesc desc = describePass(
        "edge", motion_blur_edge_comp, {kSampled, kSampled, kSampled, kSampled, kStorage}
    );
    desc.specialization = {everywhere ? 1u : 0u};
    return desc;
}

} // namespace

RayMask::RayMask(gpu::Device& device)
    : mSampler(device.nearestSampler()), mEdge(device, describeEdge(false)),
      mEdgeEverywhere(device, describeEdge(true)),
      mMask(
          device,
          describePass(
              "ray mask",
              motion_blur_mask_comp,
              {kSampled, kSampled, kSampled, kStorage, kBuffer, kBuffer}
          )
      ) {}

RayMaskOutputs RayMask::add(
    graph::Graph& graph, const RayMaskInputs& inputs, const shader::MotionBlurParams& params
) const {
    using graph::Access;
    const glm::uvec2 size = params.sizePx;
    RayMaskOutputs outputs;
    outputs.edge = graph.createImage("edge", {size.x, size.y, VK_FORMAT_R8G8B8A8_UNORM});
    outputs.mask = graph.createImage("ray mask", {size.x, size.y, VK_FORMAT_R8_UNORM});
    outputs.list = graph.createBuffer(
        "masked pixels",
        {sizeof(shader::MaskHeader) + VkDeviceSize(size.x) * size.y * sizeof(uint32_t),
         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}
    );
    outputs.arguments = graph.createBuffer(
        "reveal arguments",
        {sizeof(shader::RevealArguments),
         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT}
    );

    struct EdgeData {
        RayMaskInputs in;
        graph::ImageHandle edge;
    };

    graph.addPass<EdgeData>(
        "edge",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, EdgeData& data) {
            data.in = inputs;
            for (graph::ImageHandle image :
                 {inputs.motionDepth, inputs.normal, inputs.meshId, inputs.dominant})
                builder.read(image, Access::SampledCompute);
            data.edge = outputs.edge = builder.write(outputs.edge, Access::StorageWrite);
        },
        [this, params](const EdgeData& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            bindings.sampled(resources.view(data.in.motionDepth), mSampler)
                .sampled(resources.view(data.in.normal), mSampler)
                .sampled(resources.view(data.in.meshId), mSampler)
                .sampled(resources.view(data.in.dominant), mSampler)
                .storage(resources.view(data.edge));
            const gpu::Pipeline& pipeline = data.in.measureEverywhere ? mEdgeEverywhere : mEdge;
            dispatchPixels(context, pipeline, bindings, params, params.sizePx);
        }
    );

    struct ClearData {
        graph::BufferHandle list;
        graph::BufferHandle arguments;
    };

    graph.addPass<ClearData>(
        "clear ray mask list",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, ClearData& data) {
            data.list = outputs.list = builder.write(outputs.list, Access::TransferWrite);
            data.arguments = outputs.arguments =
                builder.write(outputs.arguments, Access::TransferWrite);
        },
        [](const ClearData& data, graph::PassContext& context) {
            const shader::MaskHeader header{};
            const shader::RevealArguments arguments{0, 1, 1};
            vkCmdUpdateBuffer(
                context.commands, context.resources.buffer(data.list), 0, sizeof(header), &header
            );
            vkCmdUpdateBuffer(
                context.commands,
                context.resources.buffer(data.arguments),
                0,
                sizeof(arguments),
                &arguments
            );
        }
    );

    struct MaskData {
        graph::ImageHandle motionDepth, dominant, edge, mask;
        graph::BufferHandle list, arguments;
    };

    graph.addPass<MaskData>(
        "ray mask",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, MaskData& data) {
            data.motionDepth = builder.read(inputs.motionDepth, Access::SampledCompute);
            data.dominant = builder.read(inputs.dominant, Access::SampledCompute);
            data.edge = builder.read(outputs.edge, Access::SampledCompute);
            data.mask = outputs.mask = builder.write(outputs.mask, Access::StorageWrite);
            data.list = outputs.list = builder.write(outputs.list, Access::StorageWrite);
            data.arguments = outputs.arguments =
                builder.write(outputs.arguments, Access::StorageWrite);
        },
        [this, params](const MaskData& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            bindings.sampled(resources.view(data.motionDepth), mSampler)
                .sampled(resources.view(data.dominant), mSampler)
                .sampled(resources.view(data.edge), mSampler)
                .storage(resources.view(data.mask))
                .buffer(resources.buffer(data.list))
                .buffer(resources.buffer(data.arguments));
            dispatchPixels(context, mMask, bindings, params, params.sizePx);
        }
    );
    return outputs;
}

} // namespace shutter::motion_blur
