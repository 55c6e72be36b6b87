// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/tile_motion.h"

#include "spirv/motion_blur/neighbour_max.comp.h"
#include "spirv/motion_blur/tile_max.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

TileMotion::TileMotion(gpu::Device& device)
    : mSampler(device.nearestSampler()),
      mTileMax(device, describePass("tile max", motion_blur_tile_max_comp, {kSampled, kStorage})),
      mNeighbourMax(
          device,
          describePass("neighbour max", motion_blur_neighbour_max_comp, {kSampled, kStorage})
      ) {}

TileMotionOutputs TileMotion::add(
    graph::Graph& graph,
    graph::ImageHandle motionDepth,
    const shader::MotionBlurParams& params,
    const std::string& suffix
) const {
    using graph::Access;

    struct Data {
        graph::ImageHandle source;
        graph::ImageHandle target;
    };

    const graph::TransientImageDesc desc{
        params.tileCount.x, params.tileCount.y, VK_FORMAT_R32G32_SFLOAT};
    TileMotionOutputs outputs;
    outputs.tiles = graph.createImage("tiles" + suffix, desc);
    outputs.dominant = graph.createImage("dominant motion" + suffix, desc);
    graph.addPass<Data>(
        "tile max" + suffix,
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.source = builder.read(motionDepth, Access::SampledCompute);
            data.target = outputs.tiles = builder.write(outputs.tiles, Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            bindings.sampled(context.resources.view(data.source), mSampler)
                .storage(context.resources.view(data.target));
            context.frame.bind(mTileMax, bindings, &params, sizeof(params));
            vkCmdDispatch(context.commands, params.tileCount.x, params.tileCount.y, 1);
        }
    );
    graph.addPass<Data>(
        "neighbour max" + suffix,
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.source = builder.read(outputs.tiles, Access::SampledCompute);
            data.target = outputs.dominant = builder.write(outputs.dominant, Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            bindings.sampled(context.resources.view(data.source), mSampler)
                .storage(context.resources.view(data.target));
            dispatchPixels(context, mNeighbourMax, bindings, params, params.tileCount);
        }
    );
    return outputs;
}

} // namespace shutter::motion_blur
