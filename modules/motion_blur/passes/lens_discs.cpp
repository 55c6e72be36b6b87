// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/lens_discs.h"

#include "spirv/motion_blur/draw_bright_points.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describeDraw() {
    std::vector<VkDescriptorType> bindings = listSearchBindings();
    bindings.insert(bindings.end(), {kStorage, kBuffer, kBuffer});
    gpu::ComputePipelineDesc desc = describePass(
        "draw bright points", motion_blur_draw_bright_points_comp, std::move(bindings)
    );
    desc.subgroupSize = kDivergingSubgroup;
    return desc;
}

} // namespace

LensDiscs::LensDiscs(gpu::Device& device) : mDevice(device), mPipelines(device, describeDraw()) {}

graph::ImageHandle LensDiscs::add(
    graph::Graph& graph,
    const ResolvePassOutputs& found,
    graph::ImageHandle picture,
    const PassParams& params
) const {
    const BrightPointBuffers& points = found.points;
    if (!points.counts.isValid())
        return picture;

    struct Data {
        SearchResources search;
        graph::ImageHandle picture;
    };

    return graph
        .addPass<Data>(
            "draw bright points",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                data.search = found.search;
                data.search.use(builder);
                mPipelines.prepare(data.search, data.search.isGeneral);
                builder.read(points.counts, Access::StorageRead);
                builder.read(points.points, Access::StorageRead);
                builder.read(points.arguments, Access::IndirectRead);
                data.picture = builder.write(picture, Access::StorageWrite);
            },
            [this, points, params](const Data& data, graph::PassContext& context) {
                const graph::PassResources& resources = context.resources;
                gpu::BindingList bindings = data.search.bind(resources, mDevice, data.picture);
                bindings.storage(resources.image(data.picture))
                    .buffer(resources.buffer(points.counts))
                    .buffer(resources.buffer(points.points));
                dispatchList(
                    context,
                    mPipelines.get(data.search, data.search.isGeneral),
                    bindings,
                    withCrowds(params, resources, data.search.crowds),
                    points.arguments,
                    0
                );
            }
        )
        .picture;
}

} // namespace shutter::motion_blur
