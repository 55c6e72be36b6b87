// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/cost_view.h"

#include "spirv/motion_blur/cost_view.comp.h"

#include "engine/graph/execute.h"

#include <array>

namespace shutter::motion_blur {

namespace {

graph::ImageHandle addCleared(graph::Graph& graph, const PassParams& params) {
    struct Data {
        graph::ImageHandle image;
    };

    const auto image =
        graph.createImage("cost", {params.sizePx.x, params.sizePx.y, VK_FORMAT_R32_SFLOAT});
    return graph
        .addPass<Data>(
            "clear cost",
            graph::PassKind::Transfer,
            [&](graph::PassBuilder& builder, Data& data) {
                data.image = builder.write(image, graph::Access::TransferWrite);
            },
            [](const Data& data, graph::PassContext& context) {
                const VkClearColorValue zero{};
                const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
                vkCmdClearColorImage(
                    context.commands,
                    context.resources.image(data.image).handle(),
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                    &zero,
                    1,
                    &all
                );
            }
        )
        .image;
}

} // namespace

CostView::CostView(gpu::Device& device)
    : mUniform(device, shader::kUniformList, {"cost, uniform", motion_blur_cost_view_comp, 1, {1}}),
      mMixed(device, shader::kMixedList, {"cost, mixed", motion_blur_cost_view_comp, 1, {2}}),
      mCandidates(
          device, shader::kCandidateList, {"cost, candidates", motion_blur_cost_view_comp, 1, {2}}
      ),
      mMasked(
          device,
          shader::kMaskedList,
          {"cost, masked", motion_blur_cost_view_comp, 1, {4, kFetchesPerRay}}
      ) {}

graph::ImageHandle CostView::add(
    graph::Graph& graph,
    graph::ImageHandle motionDepth,
    graph::ImageHandle mask,
    const SortedBlocks& blocks,
    const PassParams& params
) const {
    const bool hasMask = mask.isValid();
    const std::array inputs{hasMask ? mask : motionDepth};
    graph::ImageHandle cost = addCleared(graph, params);
    cost = mUniform.add(graph, inputs, blocks.lists, cost, params);
    cost = mMixed.add(graph, inputs, blocks.lists, cost, params);
    if (!hasMask)
        return cost;
    cost = mCandidates.add(graph, inputs, blocks.candidates, cost, params);
    return mMasked.add(graph, inputs, blocks.lists, cost, params);
}

} // namespace shutter::motion_blur
