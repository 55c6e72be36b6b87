// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/block_filter.h"

#include "engine/core/check.h"
#include "modules/motion_blur/passes/dispatch.h"

#include <vector>

namespace shutter::motion_blur {

namespace {

std::vector<VkDescriptorType> describeBindings(uint32_t inputCount) {
    std::vector<VkDescriptorType> bindings(inputCount, kSampled);
    bindings.push_back(kStorage);
    bindings.push_back(kBuffer);
    return bindings;
}

} // namespace

BlockFilter::BlockFilter(
    gpu::Device& device,
    std::string name,
    std::span<const uint32_t> spirv,
    uint32_t inputCount,
    uint32_t list,
    std::vector<uint32_t> constants
)
    : mName(std::move(name)), mInputCount(inputCount), mList(list),
      mSampler(device.nearestSampler()) {
    gpu::ComputePipelineDesc desc = describePass(mName, spirv, describeBindings(inputCount));
    desc.specialization = std::move(constants);
    desc.specialization.insert(desc.specialization.begin(), list);
    mPipeline = gpu::Pipeline(device, desc);
}

graph::ImageHandle BlockFilter::add(
    graph::Graph& graph,
    std::span<const graph::ImageHandle> inputs,
    const BlockLists& lists,
    graph::ImageHandle target,
    const shader::MotionBlurParams& params
) const {
    using graph::Access;

    struct Data {
        std::vector<graph::ImageHandle> inputs;
        BlockLists lists;
        graph::ImageHandle target;
    };

    SHUTTER_CHECK_EQ(inputs.size(), mInputCount);
    const Data& pass = graph.addPass<Data>(
        mName,
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            for (graph::ImageHandle image : inputs)
                data.inputs.push_back(builder.read(image, Access::SampledCompute));
            data.lists = {
                builder.read(lists.blocks, Access::StorageRead),
                builder.read(lists.arguments, Access::IndirectRead)};
            data.target = builder.write(target, Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            for (graph::ImageHandle image : data.inputs)
                bindings.sampled(context.resources.view(image), mSampler);
            bindings.storage(context.resources.image(data.target))
                .buffer(context.resources.buffer(data.lists.blocks));
            dispatchList(context, mPipeline, bindings, params, data.lists.arguments, mList);
        }
    );
    return pass.target;
}

} // namespace shutter::motion_blur
