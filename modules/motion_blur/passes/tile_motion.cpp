// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/tile_motion.h"

#include "spirv/motion_blur/guertin_tiles.comp.h"
#include "spirv/motion_blur/neighbour_max.comp.h"
#include "spirv/motion_blur/tile_max.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

#include <algorithm>
#include <bit>

namespace shutter::motion_blur {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describeTileMax(const gpu::Device& device) {
    gpu::ComputePipelineDesc desc =
        describePass("tile max", motion_blur_tile_max_comp, {kSampled, kStorage, kStorage});
    const uint32_t threads = shader::kTileColumns * countTileRows(device);
    desc.specialization = {threads, threads};
    return desc;
}

} // namespace

uint32_t countTileRows(const gpu::Device& device) {
    if (isSoftware(device))
        return 1;
    constexpr uint32_t kMaxRows = 32;
    const VkPhysicalDeviceLimits& limits = device.limits();
    const uint32_t threads =
        std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);
    return std::min(kMaxRows, std::bit_floor(threads / shader::kTileColumns));
}

TileMotion::TileMotion(gpu::Device& device)
    : mSampler(device.nearestSampler()), mTileMax(device, describeTileMax(device)),
      mNeighbourMax(
          device,
          describePass(
              "neighbour max",
              motion_blur_neighbour_max_comp,
              {kSampled, kSampled, kStorage, kStorage}
          )
      ) {}

TileMaxOutputs TileMotion::addTileMax(
    graph::Graph& graph, graph::ImageHandle motionDepth, const PassParams& params
) const {
    struct Data {
        graph::ImageHandle motionDepth;
        TileMaxOutputs out;
    };

    const glm::uvec2 size = params.tileCount;
    const Data& pass = graph.addPass<Data>(
        "tile max",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.motionDepth = builder.read(motionDepth, Access::SampledCompute);
            data.out.tiles = builder.write(
                graph.createImage("tiles", {size.x, size.y, VK_FORMAT_R32G32_SFLOAT}),
                Access::StorageWrite
            );
            data.out.ranges = builder.write(
                graph.createImage("tile ranges", {size.x, size.y, VK_FORMAT_R32G32B32A32_SFLOAT}),
                Access::StorageWrite
            );
        },
        [this, params](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            bindings.sampled(context.resources.view(data.motionDepth), mSampler)
                .storage(context.resources.image(data.out.tiles))
                .storage(context.resources.image(data.out.ranges));
            context.frame.bind(mTileMax.get(), bindings, &params, sizeof(params));
            vkCmdDispatch(context.commands, params.tileCount.x, params.tileCount.y, 1);
        }
    );
    return pass.out;
}

TileMotionOutputs TileMotion::add(
    graph::Graph& graph, graph::ImageHandle motionDepth, const PassParams& params
) const {
    struct Data {
        TileMaxOutputs in;
        TileMotionOutputs out;
    };

    const TileMaxOutputs tileMax = addTileMax(graph, motionDepth, params);
    const glm::uvec2 size = params.tileCount;
    const Data& pass = graph.addPass<Data>(
        "neighbour max",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.in = tileMax;
            builder.read(tileMax.tiles, Access::SampledCompute);
            builder.read(tileMax.ranges, Access::SampledCompute);
            data.out.tiles = tileMax.tiles;
            data.out.dominant = builder.write(
                graph.createImage("dominant motion", {size.x, size.y, VK_FORMAT_R32G32_SFLOAT}),
                Access::StorageWrite
            );
            data.out.tileClass = builder.write(
                graph.createImage("tile class", {size.x, size.y, VK_FORMAT_R32_SFLOAT}),
                Access::StorageWrite
            );
        },
        [this, params](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            bindings.sampled(context.resources.view(data.in.tiles), mSampler)
                .sampled(context.resources.view(data.in.ranges), mSampler)
                .storage(context.resources.image(data.out.dominant))
                .storage(context.resources.image(data.out.tileClass));
            dispatchPixels(context, mNeighbourMax.get(), bindings, params, params.tileCount);
        }
    );
    return pass.out;
}

GuertinTiles::GuertinTiles(gpu::Device& device)
    : mSampler(device.nearestSampler()),
      mPipeline(
          device,
          describePass(
              "guertin tiles", motion_blur_guertin_tiles_comp, {kSampled, kStorage, kStorage}
          )
      ) {}

GuertinTilesOutputs
GuertinTiles::add(graph::Graph& graph, graph::ImageHandle tiles, const PassParams& params) const {
    using graph::Access;

    struct Data {
        graph::ImageHandle tiles;
        GuertinTilesOutputs outputs;
    };

    const Data& pass = graph.addPass<Data>(
        "guertin tiles",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            const glm::uvec2 size = params.tileCount;
            data.tiles = builder.read(tiles, Access::SampledCompute);
            data.outputs.dominant = builder.write(
                graph.createImage("dominant motion", {size.x, size.y, VK_FORMAT_R32G32_SFLOAT}),
                Access::StorageWrite
            );
            data.outputs.variance = builder.write(
                graph.createImage("motion variance", {size.x, size.y, VK_FORMAT_R32_SFLOAT}),
                Access::StorageWrite
            );
        },
        [this, params](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            bindings.sampled(context.resources.view(data.tiles), mSampler)
                .storage(context.resources.image(data.outputs.dominant))
                .storage(context.resources.image(data.outputs.variance));
            dispatchPixels(context, mPipeline.get(), bindings, params, params.tileCount);
        }
    );
    return pass.outputs;
}

} // namespace shutter::motion_blur
