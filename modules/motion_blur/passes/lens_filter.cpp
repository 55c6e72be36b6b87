// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/lens_filter.h"

#include "spirv/motion_blur/lens_filter.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

LensFilter::LensFilter(gpu::Device& device)
    : mSampler(device.nearestSampler()),
      mPipeline(
          device, describePass("filter lens", motion_blur_lens_filter_comp, {kSampled, kStorage})
      ) {}

graph::ImageHandle LensFilter::add(
    graph::Graph& graph,
    graph::ImageHandle picture,
    graph::ImageHandle target,
    const PassParams& params
) const {
    using graph::Access;

    if (!target.isValid())
        target = graph.createImage("seen through the lens", graph.describeImage(picture));

    struct Data {
        graph::ImageHandle picture;
        graph::ImageHandle filtered;
    };

    return graph
        .addPass<Data>(
            "filter lens",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                data.picture = builder.read(picture, Access::SampledCompute);
                data.filtered = builder.write(target, Access::StorageWrite);
            },
            [this, params](const Data& data, graph::PassContext& context) {
                gpu::BindingList bindings;
                bindings.sampled(context.resources.view(data.picture), mSampler)
                    .storage(context.resources.image(data.filtered));
                dispatchPixels(context, mPipeline.get(), bindings, params, params.sizePx);
            }
        )
        .filtered;
}

} // namespace shutter::motion_blur
