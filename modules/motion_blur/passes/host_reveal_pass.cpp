// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/host_reveal_pass.h"

#include "engine/graph/execute.h"
#include "shaders/motion_blur/motion_blur_shared.h"

namespace shutter::motion_blur {

RayRevealOutputs addHostReveal(
    graph::Graph& graph,
    const gpu::Device& device,
    const RayRevealInputs& inputs,
    const HostReveal& own
) {
    using graph::Access;

    struct Data {
        RayRevealOutputs out;
        graph::BufferHandle list;
        graph::BufferHandle groups;
        graph::BufferHandle launch;
    };

    const RayRevealOutputs outputs = createRevealed(graph, inputs);
    const graph::BufferHandle launch = own.byRayPipeline && device.info().tracesIndirect
                                           ? addLaunchSize(graph, inputs.masked.list)
                                           : graph::BufferHandle{};
    const graph::TransientImageDesc& size = graph.describeImage(inputs.color);
    const VkDeviceSize listBytes =
        sizeof(shader::MaskHeader) + VkDeviceSize(size.width) * size.height * sizeof(uint32_t);
    return graph
        .addPass<Data>(
            "own reveal",
            own.byRayPipeline ? graph::PassKind::RayTracing : graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                for (const auto image : {inputs.color, inputs.motionDepth, inputs.entityId})
                    builder.read(image, Access::SampledCompute);
                data.out.color = builder.write(outputs.color, Access::StorageWrite);
                data.out.motionDepth = builder.write(outputs.motionDepth, Access::StorageWrite);
                data.out.entityId = builder.write(outputs.entityId, Access::StorageWrite);
                data.list = builder.read(inputs.masked.list, Access::StorageRead);
                data.groups = builder.read(inputs.masked.arguments, Access::IndirectRead);
                if (launch.isValid())
                    data.launch = builder.read(launch, Access::IndirectRead);
            },
            [&own, size, listBytes](const Data& data, graph::PassContext& context) {
                const graph::PassResources& resources = context.resources;
                auto task = makeTask<RevealTask>(context.commands, {size.width, size.height});
                task.list = resources.buffer(data.list);
                task.listAddress = resources.address(data.list);
                task.listBytes = listBytes;
                task.groups = resources.buffer(data.groups);
                if (data.launch.isValid()) {
                    task.launch = resources.buffer(data.launch);
                    task.launchAddress = resources.address(data.launch);
                }
                const auto give = [&](graph::ImageHandle image) -> ShutterBlurRevealTarget {
                    return {resources.image(image).handle(), resources.view(image)};
                };
                task.color = give(data.out.color);
                task.motionDepth = give(data.out.motionDepth);
                task.entityId = give(data.out.entityId);
                own.record(task);
            }
        )
        .out;
}

} // namespace shutter::motion_blur
