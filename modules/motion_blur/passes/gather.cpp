// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/gather.h"

#include "spirv/motion_blur/reconstruct.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

#include <array>

namespace shutter::motion_blur {

namespace {

constexpr size_t kLayerImages = 7; // sampled bindings of reconstruct.comp

gpu::ComputePipelineDesc describeReconstruct(bool hybrid) {
    std::vector<VkDescriptorType> bindings(kLayerImages, kSampled);
    bindings.push_back(kStorage);
    gpu::ComputePipelineDesc desc = describePass(
        hybrid ? "gather and composite" : "gather",
        motion_blur_reconstruct_comp,
        std::move(bindings)
    );
    desc.specialization = {hybrid ? 1u : 0u};
    return desc;
}

} // namespace

Gather::Gather(gpu::Device& device)
    : mSampler(device.nearestSampler()), mOneLayer(device, describeReconstruct(false)),
      mTwoLayers(device, describeReconstruct(true)) {}

graph::ImageHandle Gather::add(
    graph::Graph& graph, const GatherInputs& inputs, const shader::MotionBlurParams& params
) const {
    using graph::Access;

    struct Data {
        std::array<graph::ImageHandle, kLayerImages> images;
        graph::ImageHandle blurred;
    };

    const bool hybrid = inputs.reveal.has_value();
    // With one layer the shader never reads the second one's bindings; they still need an image.
    const RevealedLayer second =
        hybrid ? *inputs.reveal
               : RevealedLayer{inputs.color, inputs.motionDepth, inputs.dominant, inputs.color};
    const Data& pass = graph.addPass<Data>(
        hybrid ? "gather and composite" : "gather",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.images = {
                inputs.color,
                inputs.motionDepth,
                inputs.dominant,
                second.color,
                second.motionDepth,
                second.dominant,
                second.mask};
            for (graph::ImageHandle image : data.images)
                builder.read(image, Access::SampledCompute);
            const auto blurred = graph.createImage("blurred", graph.describeImage(inputs.color));
            data.blurred = builder.write(blurred, Access::StorageWrite);
        },
        [this, params, hybrid](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            for (graph::ImageHandle image : data.images)
                bindings.sampled(context.resources.view(image), mSampler);
            bindings.storage(context.resources.view(data.blurred));
            dispatchPixels(
                context, hybrid ? mTwoLayers : mOneLayer, bindings, params, params.sizePx
            );
        }
    );
    return pass.blurred;
}

} // namespace shutter::motion_blur
