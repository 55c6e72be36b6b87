// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/screen_filter.h"

#include "engine/core/check.h"
#include "modules/motion_blur/passes/dispatch.h"

#include <vector>

namespace shutter::motion_blur {

namespace {

std::vector<VkDescriptorType> describeBindings(uint32_t inputCount) {
    std::vector<VkDescriptorType> bindings(inputCount, kSampled);
    bindings.push_back(kStorage);
    return bindings;
}

} // namespace

ScreenFilter::ScreenFilter(
    gpu::Device& device, std::string name, std::span<const uint32_t> spirv, uint32_t inputCount
)
    : mName(std::move(name)), mInputCount(inputCount), mSampler(device.nearestSampler()),
      mPipeline(device, describePass(mName, spirv, describeBindings(inputCount))) {}

graph::ImageHandle ScreenFilter::add(
    graph::Graph& graph,
    std::span<const graph::ImageHandle> inputs,
    const shader::MotionBlurParams& params,
    const std::string& suffix
) const {
    using graph::Access;

    struct Data {
        std::vector<graph::ImageHandle> inputs;
        graph::ImageHandle blurred;
    };

    SHUTTER_CHECK_EQ(inputs.size(), mInputCount);
    const Data& pass = graph.addPass<Data>(
        mName + suffix,
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            for (graph::ImageHandle image : inputs)
                data.inputs.push_back(builder.read(image, Access::SampledCompute));
            const auto blurred = graph.createImage("blurred", graph.describeImage(inputs.front()));
            data.blurred = builder.write(blurred, Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            for (graph::ImageHandle image : data.inputs)
                bindings.sampled(context.resources.view(image), mSampler);
            bindings.storage(context.resources.image(data.blurred));
            dispatchPixels(context, mPipeline, bindings, params, params.sizePx);
        }
    );
    return pass.blurred;
}

} // namespace shutter::motion_blur
