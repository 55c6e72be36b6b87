// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/composite.h"

#include "spirv/motion_blur/composite.comp.h"

#include "engine/graph/execute.h"
#include "modules/motion_blur/passes/dispatch.h"
#include "shaders/motion_blur/composite_shared.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describeComposite(bool hasParts) {
    gpu::ComputePipelineDesc desc;
    desc.name = "composite blended";
    desc.spirv = motion_blur_composite_comp;
    desc.interface.bindings = {kSampled, kSampled, kStorage, kStorage, kBuffer};
    desc.interface.pushConstantBytes = sizeof(shader::CompositeParams);
    desc.specialization = {hasParts ? 1u : 0u};
    return desc;
}

} // namespace

Composite::Composite(gpu::Device& device)
    : mDevice(device), mWhole(device, describeComposite(false)),
      mParts(device, describeComposite(true)), mNoSurfaces(
                                                   device,
                                                   "no instant surfaces",
                                                   sizeof(shader::InstantSurfaces),
                                                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                                   gpu::MemoryUse::Device
                                               ) {}

graph::ImageHandle Composite::add(
    graph::Graph& graph,
    graph::ImageHandle picture,
    const DrawBlendedPart& draw,
    const shader::InstantSurfaces& rectangle,
    graph::BufferHandle surfaces
) {
    struct Data {
        BlendedSums part;
        graph::ImageHandle picture;
        graph::ImageHandle sum; ///< invalid: there is one part
        graph::BufferHandle surfaces;
    };

    graph::ImageHandle sum;
    const glm::uvec2 allocated = shader::sizeInSteps(rectangle.sizePx);
    if (rectangle.partCount > 1)
        sum = graph.createImage(
            "composite sum", {allocated.x, allocated.y, VK_FORMAT_R16G16B16A16_SFLOAT}
        );
    shader::CompositeParams params{};
    params.originPx = rectangle.originPx;
    params.sizePx = rectangle.sizePx;
    params.partCount = rectangle.partCount;
    for (; params.part < params.partCount; ++params.part) {
        const BlendedSums part = draw(params.part);
        params.share = part.share;
        params.isOpacityInAlpha = part.opacity.isValid() ? 0 : 1;
        const Data& pass = graph.addPass<Data>(
            "composite blended",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                data.part = part;
                builder.read(part.color, Access::SampledCompute);
                if (part.opacity.isValid())
                    builder.read(part.opacity, Access::SampledCompute);
                data.surfaces = surfaces;
                if (surfaces.isValid())
                    builder.read(surfaces, Access::StorageRead);
                data.picture = builder.write(picture, Access::StorageWrite);
                if (sum.isValid())
                    data.sum = builder.write(sum, Access::StorageWrite);
            },
            [this, params](const Data& data, graph::PassContext& context) {
                const graph::PassResources& resources = context.resources;
                const graph::ImageHandle color = data.part.color;
                const graph::ImageHandle opacity =
                    data.part.opacity.isValid() ? data.part.opacity : color;
                gpu::BindingList bindings;
                for (const graph::ImageHandle image : {color, opacity})
                    bindings.sampled(resources.view(image), mDevice.nearestSampler());
                // Unused bindings still need a valid descriptor.
                bindings.storage(resources.image(data.picture))
                    .storage(resources.image(data.sum.isValid() ? data.sum : data.picture));
                const bool hasParts = data.surfaces.isValid();
                bindings.buffer(hasParts ? resources.buffer(data.surfaces) : mNoSurfaces.handle());
                context.frame.bind(
                    (hasParts ? mParts : mWhole).get(), bindings, &params, sizeof(params)
                );
                const glm::uvec2 groups =
                    (params.sizePx + shader::kGroupSize - 1u) / shader::kGroupSize;
                vkCmdDispatch(context.commands, groups.x, groups.y, 1);
            }
        );
        picture = pass.picture;
        sum = pass.sum;
    }
    return picture;
}

} // namespace shutter::motion_blur
