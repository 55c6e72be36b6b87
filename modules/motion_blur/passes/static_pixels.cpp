// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/static_pixels.h"

#include "spirv/motion_blur/copy_blocks.comp.h"

#include "engine/graph/execute.h"
#include "modules/motion_blur/passes/dispatch.h"

#include <array>

namespace shutter::motion_blur {

namespace {

using graph::Access;

/// \param given invalid: a new image
graph::ImageHandle
findTarget(graph::Graph& graph, graph::ImageHandle color, graph::ImageHandle given) {
    return given.isValid() ? given : graph.createImage("blurred", graph.describeImage(color));
}

} // namespace

StaticPixelsBy chooseStaticPixels(double movingShare, StaticPixelsBy last) {
    // The two cost the same where a quarter of the picture moves.
    if (movingShare < 0.2)
        return StaticPixelsBy::CopyBack;
    if (movingShare > 0.3)
        return StaticPixelsBy::WholeCopy;
    return last;
}

StaticPixels::StaticPixels(gpu::Device& device)
    : mListsStill(BlockSorter::listsStill(device)),
      mStill(device, shader::kStillList, {"copy still pixels", motion_blur_copy_blocks_comp, 1}),
      mUniform(
          device, shader::kUniformList, {"write uniform blocks", motion_blur_copy_blocks_comp, 1}
      ),
      mMixed(device, shader::kMixedList, {"write mixed blocks", motion_blur_copy_blocks_comp, 1}),
      mCandidates(
          device,
          shader::kCandidateList,
          {"write candidate blocks", motion_blur_copy_blocks_comp, 1}
      ) {}

graph::ImageHandle StaticPixels::begin(
    graph::Graph& graph,
    graph::ImageHandle color,
    graph::ImageHandle wholeTarget,
    StaticPixelsBy by,
    const BlockLists& sorted,
    const PassParams& params
) const {
    if (!mListsStill || by != StaticPixelsBy::WholeCopy)
        return begin(graph, color, wholeTarget, by);
    return mStill.add(
        graph, std::array{color}, sorted, findTarget(graph, color, wholeTarget), params
    );
}

graph::ImageHandle StaticPixels::begin(
    graph::Graph& graph, graph::ImageHandle color, graph::ImageHandle wholeTarget, StaticPixelsBy by
) const {
    if (by == StaticPixelsBy::InPlace)
        return color;
    if (by == StaticPixelsBy::CopyBack)
        return findTarget(graph, color, {});
    const graph::ImageHandle target = findTarget(graph, color, wholeTarget);

    struct Data {
        graph::ImageHandle source;
        graph::ImageHandle target;
    };

    const Data& pass = graph.addPass<Data>(
        "copy still pixels",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Data& data) {
            data.source = builder.read(color, Access::TransferRead);
            data.target = builder.write(target, Access::TransferWrite);
        },
        [](const Data& data, graph::PassContext& context) {
            copyWhole(context, data.source, data.target);
        }
    );
    return pass.target;
}

graph::ImageHandle StaticPixels::end(
    graph::Graph& graph,
    graph::ImageHandle color,
    graph::ImageHandle filtered,
    const SortedBlocks& blocks,
    bool hasCandidates,
    const PassParams& params,
    StaticPixelsBy by
) const {
    if (by != StaticPixelsBy::CopyBack)
        return filtered;
    const std::array source{filtered};
    if (params.uniformMotionPx > 0.0f)
        color = mUniform.add(graph, source, blocks.lists, color, params);
    color = mMixed.add(graph, source, blocks.lists, color, params);
    if (hasCandidates)
        color = mCandidates.add(graph, source, blocks.candidates, color, params);
    return color;
}

} // namespace shutter::motion_blur
