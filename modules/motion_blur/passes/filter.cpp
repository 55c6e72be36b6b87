// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/filter.h"

#include "engine/core/check.h"
#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

struct FilterData {
    std::vector<graph::ImageHandle> inputs;
    BlockLists lists; ///< invalid handles over the whole picture
    graph::ImageHandle target;
};

/// \param list number of the list, which the shader then has at its last binding
gpu::ComputePipelineDesc describe(const FilterDesc& filter, std::optional<uint32_t> list) {
    std::vector<VkDescriptorType> bindings(filter.inputCount, kSampled);
    bindings.push_back(kStorage);
    if (list)
        bindings.push_back(kBuffer);
    gpu::ComputePipelineDesc desc = describePass(filter.name, filter.spirv, std::move(bindings));
    desc.specialization = filter.constants;
    if (list)
        desc.specialization.insert(desc.specialization.begin(), *list);
    return desc;
}

void readAndWrite(
    graph::PassBuilder& builder,
    FilterData& data,
    std::span<const graph::ImageHandle> inputs,
    graph::ImageHandle target,
    Access write
) {
    for (const graph::ImageHandle image : inputs)
        data.inputs.push_back(builder.read(image, Access::SampledCompute));
    data.target = builder.write(target, write);
}

gpu::BindingList
bindImages(const FilterData& data, const graph::PassResources& resources, VkSampler sampler) {
    gpu::BindingList bindings;
    for (const graph::ImageHandle image : data.inputs)
        bindings.sampled(resources.view(image), sampler);
    bindings.storage(resources.image(data.target));
    return bindings;
}

} // namespace

ScreenFilter::ScreenFilter(gpu::Device& device, FilterDesc desc)
    : mName(desc.name), mInputCount(desc.inputCount), mSampler(device.nearestSampler()),
      mPipeline(device, describe(desc, std::nullopt)) {}

graph::ImageHandle ScreenFilter::add(
    graph::Graph& graph,
    std::span<const graph::ImageHandle> inputs,
    const PassParams& params,
    const std::string& suffix
) const {
    SHUTTER_CHECK_EQ(inputs.size(), mInputCount);
    const auto target = graph.createImage("blurred", graph.describeImage(inputs.front()));
    return graph
        .addPass<FilterData>(
            mName + suffix,
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, FilterData& data) {
                readAndWrite(builder, data, inputs, target, Access::StorageWrite);
            },
            [this, params](const FilterData& data, graph::PassContext& context) {
                const auto bindings = bindImages(data, context.resources, mSampler);
                dispatchPixels(context, mPipeline.get(), bindings, params, params.sizePx);
            }
        )
        .target;
}

BlockFilter::BlockFilter(gpu::Device& device, uint32_t list, FilterDesc desc)
    : BlockFilter(
          device, list, desc, desc.hasTapConstants ? chooseTapVariants(device) : TapVariants::None
      ) {}

BlockFilter::BlockFilter(gpu::Device& device, uint32_t list, FilterDesc desc, TapVariants taps)
    : mName(desc.name), mInputCount(desc.inputCount), mList(list),
      mSampler(device.nearestSampler()), mPipelines(device, describe(desc, list), taps) {}

graph::ImageHandle BlockFilter::add(
    graph::Graph& graph,
    std::span<const graph::ImageHandle> inputs,
    const BlockLists& lists,
    graph::ImageHandle target,
    const PassParams& params
) const {
    SHUTTER_CHECK_EQ(inputs.size(), mInputCount);
    return graph
        .addPass<FilterData>(
            mName,
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, FilterData& data) {
                readAndWrite(builder, data, inputs, target, Access::StorageWriteDisjoint);
                data.lists = readList(builder, lists);
            },
            [this, params](const FilterData& data, graph::PassContext& context) {
                auto bindings = bindImages(data, context.resources, mSampler);
                bindings.buffer(context.resources.buffer(data.lists.blocks));
                dispatchList(
                    context, mPipelines.find(params), bindings, params, data.lists.arguments, mList
                );
            }
        )
        .target;
}

} // namespace shutter::motion_blur
