// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/stochastic_rays.h"

#include "spirv/motion_blur/stochastic.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

namespace {

gpu::ComputePipelineDesc describePipeline(VkDescriptorSetLayout sceneLayout) {
    gpu::ComputePipelineDesc desc = describePass(
        "stochastic rays",
        motion_blur_stochastic_comp,
        {VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, kStorage, kStorage}
    );
    desc.interface.sceneLayout = sceneLayout;
    return desc;
}

} // namespace

StochasticRays::StochasticRays(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
    : mPipeline(device, describePipeline(sceneLayout)) {}

StochasticRaysOutputs StochasticRays::add(
    graph::Graph& graph, const graph::TimedRays& rays, const PassParams& params
) const {
    using graph::Access;
    const glm::uvec2 size = params.sizePx;
    const auto color = graph.createImage("noisy", {size.x, size.y, VK_FORMAT_R16G16B16A16_SFLOAT});
    const auto motionDepth =
        graph.createImage("noisy motion depth", {size.x, size.y, VK_FORMAT_R32G32B32A32_SFLOAT});
    return graph.addPass<StochasticRaysOutputs>(
        "stochastic rays",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, StochasticRaysOutputs& data) {
            builder.read(rays.tlasBuffer, Access::AccelerationRead);
            if (rays.boxesBuffer.isValid())
                builder.read(rays.boxesBuffer, Access::AccelerationRead);
            if (rays.deformedBuffer.isValid())
                builder.read(rays.deformedBuffer, Access::ShaderRead);
            data.color = builder.write(color, Access::StorageWrite);
            data.motionDepth = builder.write(motionDepth, Access::StorageWrite);
        },
        [this, rays, params](const StochasticRaysOutputs& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            bindings.accelerationStructure(rays.tlas)
                .storage(context.resources.image(data.color))
                .storage(context.resources.image(data.motionDepth));
            dispatchPixels(
                context, mPipeline.get(), bindings, params, params.sizePx, rays.textures
            );
        }
    );
}

} // namespace shutter::motion_blur
