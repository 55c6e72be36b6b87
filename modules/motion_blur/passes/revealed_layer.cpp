// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/revealed_layer.h"

#include "spirv/motion_blur/reveal_neighbour_max.comp.h"
#include "spirv/motion_blur/reveal_tile_max.comp.h"
#include "spirv/motion_blur/reveal_view.comp.h"

#include "modules/motion_blur/passes/dispatch.h"
#include "modules/motion_blur/passes/tile_motion.h"

#include <algorithm>
#include <array>

namespace shutter::motion_blur {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describeRevealTileMax(const gpu::Device& device) {
    gpu::ComputePipelineDesc desc = describePass(
        "tile max of reveal",
        motion_blur_reveal_tile_max_comp,
        {kSampled, kSampled, kSampled, kStorage, kBuffer}
    );
    // Few tiles have masked pixels: a software device takes a whole group for each.
    const uint32_t rows = std::max(countTileRows(device), shader::kGroupSize);
    desc.specialization = {rows, rows};
    return desc;
}

struct TileData {
    std::vector<graph::ImageHandle> in;
    graph::BufferHandle tiles;
    graph::BufferHandle arguments;
    graph::ImageHandle out;
};

} // namespace

RevealedLayerPasses::RevealedLayerPasses(gpu::Device& device)
    : mSampler(device.nearestSampler()), mTileMax(device, describeRevealTileMax(device)),
      mNeighbourMax(
          device,
          describePass(
              "neighbour max of reveal",
              motion_blur_reveal_neighbour_max_comp,
              {kSampled, kSampled, kStorage, kBuffer}
          )
      ),
      mView(
          device,
          describePass(
              "reveal view",
              motion_blur_reveal_view_comp,
              {kSampled, kSampled, kSampled, kSampled, kSampled, kStorage, kStorage}
          )
      ) {}

graph::ImageHandle RevealedLayerPasses::addDominant(
    graph::Graph& graph,
    const RevealedLayerInputs& inputs,
    const RayMaskOutputs& masked,
    const PassParams& params
) const {
    const graph::TransientImageDesc desc{
        params.tileCount.x, params.tileCount.y, VK_FORMAT_R32G32_SFLOAT};
    const auto addPass = [&](const std::string& name,
                             const gpu::LazyPipeline& pipeline,
                             std::vector<graph::ImageHandle> sampled,
                             const char* image,
                             uint32_t list) {
        return graph
            .addPass<TileData>(
                name,
                graph::PassKind::Compute,
                [&](graph::PassBuilder& builder, TileData& data) {
                    data.in = std::move(sampled);
                    for (graph::ImageHandle in : data.in)
                        builder.read(in, Access::SampledCompute);
                    data.tiles = builder.read(masked.tiles, Access::StorageRead);
                    data.arguments = builder.read(masked.tileArguments, Access::IndirectRead);
                    data.out = builder.write(graph.createImage(image, desc), Access::StorageWrite);
                },
                [this, params, &pipeline, list](const TileData& data, graph::PassContext& context) {
                    gpu::BindingList bindings;
                    for (graph::ImageHandle in : data.in)
                        bindings.sampled(context.resources.view(in), mSampler);
                    bindings.storage(context.resources.image(data.out))
                        .buffer(context.resources.buffer(data.tiles));
                    dispatchList(context, pipeline.get(), bindings, params, data.arguments, list);
                }
            )
            .out;
    };
    const graph::ImageHandle tiles = addPass(
        "tile max of reveal",
        mTileMax,
        {inputs.motionDepth, inputs.reveal.motionDepth, inputs.mask},
        "tiles of reveal",
        0
    );
    return addPass(
        "neighbour max of reveal",
        mNeighbourMax,
        {inputs.tiles, tiles},
        "dominant motion of reveal",
        1
    );
}

RevealedViews RevealedLayerPasses::addViews(
    graph::Graph& graph, const RevealedLayerInputs& inputs, const PassParams& params
) const {
    struct Data {
        std::array<graph::ImageHandle, 5> in;
        RevealedViews out;
    };

    const Data& pass = graph.addPass<Data>(
        "reveal view",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.in = {
                inputs.mask,
                inputs.color,
                inputs.motionDepth,
                inputs.reveal.color,
                inputs.reveal.motionDepth};
            for (graph::ImageHandle in : data.in)
                builder.read(in, Access::SampledCompute);
            data.out.color = builder.write(
                graph.createImage("reveal view", graph.describeImage(inputs.reveal.color)),
                Access::StorageWrite
            );
            data.out.motionDepth = builder.write(
                graph.createImage(
                    "reveal motion view", graph.describeImage(inputs.reveal.motionDepth)
                ),
                Access::StorageWrite
            );
        },
        [this, params](const Data& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            for (graph::ImageHandle in : data.in)
                bindings.sampled(context.resources.view(in), mSampler);
            bindings.storage(context.resources.image(data.out.color))
                .storage(context.resources.image(data.out.motionDepth));
            dispatchPixels(context, mView.get(), bindings, params, params.sizePx);
        }
    );
    return pass.out;
}

} // namespace shutter::motion_blur
