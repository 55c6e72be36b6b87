// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/guertin_tiles.h"

#include "spirv/motion_blur/guertin_tiles.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

GuertinTiles::GuertinTiles(gpu::Device& device)
    : mSampler(device.nearestSampler()),
      mPipeline(
          device,
          describePass(
              "guertin tiles", motion_blur_guertin_tiles_comp, {kSampled, kStorage, kStorage}
          )
      ) {}

GuertinTilesOutputs GuertinTiles::add(
    graph::Graph& graph, graph::ImageHandle tiles, const PassParams& params
) const {
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
