// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/tile_motion.h"

#include "spirv/motion_blur/neighbour_max.comp.h"
#include "spirv/motion_blur/tile_max.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

struct Data {
    graph::ImageHandle source;
    graph::ImageHandle target;
};

graph::TransientImageDesc describeTiles(const shader::MotionBlurParams& params) {
    return {params.tileCount.x, params.tileCount.y, VK_FORMAT_R32G32_SFLOAT};
}

} // namespace

TileMotion::TileMotion(gpu::Device& device)
    : mSampler(device.nearestSampler()),
      mTileMax(device, describePass("tile max", motion_blur_tile_max_comp, {kSampled, kStorage})),
      mNeighbourMax(
          device,
          describePass("neighbour max", motion_blur_neighbour_max_comp, {kSampled, kStorage})
      ) {}

graph::ImageHandle TileMotion::addTileMax(
    graph::Graph& graph,
    graph::ImageHandle motionDepth,
    const shader::MotionBlurParams& params,
    const std::string& suffix
) const {
    const Data& pass = graph.addPass<Data>(
        "tile max" + suffix,
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.source = builder.read(motionDepth, Access::SampledCompute);
            const auto tiles = graph.createImage("tiles" + suffix, describeTiles(params));
            data.target = builder.write(tiles, Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            bindings.sampled(context.resources.view(data.source), mSampler)
                .storage(context.resources.view(data.target));
            context.frame.bind(mTileMax, bindings, &params, sizeof(params));
            vkCmdDispatch(context.commands, params.tileCount.x, params.tileCount.y, 1);
        }
    );
    return pass.target;
}

TileMotionOutputs TileMotion::add(
    graph::Graph& graph,
    graph::ImageHandle motionDepth,
    const shader::MotionBlurParams& params,
    const std::string& suffix
) const {
    const graph::ImageHandle tiles = addTileMax(graph, motionDepth, params, suffix);
    const Data& pass = graph.addPass<Data>(
        "neighbour max" + suffix,
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.source = builder.read(tiles, Access::SampledCompute);
            const auto dominant =
                graph.createImage("dominant motion" + suffix, describeTiles(params));
            data.target = builder.write(dominant, Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            bindings.sampled(context.resources.view(data.source), mSampler)
                .storage(context.resources.view(data.target));
            dispatchPixels(context, mNeighbourMax, bindings, params, params.tileCount);
        }
    );
    return {tiles, pass.target};
}

} // namespace shutter::motion_blur
