// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/bright_points.h"

#include "spirv/motion_blur/find_bright_points.comp.h"
#include "spirv/motion_blur/find_bright_regions.comp.h"

#include "modules/motion_blur/passes/dispatch.h"
#include "shaders/motion_blur/bright_points_shared.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

VkDeviceSize countRegions(const PassParams& params) {
    const glm::uvec2 regions =
        (params.sizePx + shader::kPointRegionPx - 1u) / shader::kPointRegionPx;
    return VkDeviceSize(regions.x) * regions.y;
}

graph::ImageHandle addCopy(graph::Graph& graph, graph::ImageHandle color) {
    struct Data {
        graph::ImageHandle source;
        graph::ImageHandle target;
    };

    return graph
        .addPass<Data>(
            "copy layer",
            graph::PassKind::Transfer,
            [&](graph::PassBuilder& builder, Data& data) {
                data.source = builder.read(color, Access::TransferRead);
                data.target = builder.write(
                    graph.createImage("without bright points", graph.describeImage(color)),
                    Access::TransferWrite
                );
            },
            [](const Data& data, graph::PassContext& context) {
                copyWhole(context, data.source, data.target);
            }
        )
        .target;
}

} // namespace

BrightPoints::BrightPoints(gpu::Device& device)
    : mSampler(device.nearestSampler()), mRegions(
                                             device,
                                             describePass(
                                                 "find bright regions",
                                                 motion_blur_find_bright_regions_comp,
                                                 {kSampled, kBuffer, kBuffer, kBuffer}
                                             )
                                         ),
      mPoints(
          device,
          describePass(
              "find bright points",
              motion_blur_find_bright_points_comp,
              {kSampled, kSampled, kStorage, kBuffer, kBuffer, kBuffer, kBuffer}
          )
      ) {}

BrightPointBuffers
BrightPoints::create(graph::Graph& graph, const PassParams& params, Clears& clears) {
    const VkDeviceSize regions = countRegions(params);
    const BrightPointBuffers buffers{
        graph.createBuffer(
            "bright point counts",
            {sizeof(shader::PointHeader) + regions * sizeof(uint32_t), kListUsage}
        ),
        graph.createBuffer(
            "bright points",
            {regions * shader::kMaxRegionPoints * sizeof(shader::BrightPoint), kListUsage}
        ),
        graph.createBuffer(
            "bright point arguments", {sizeof(shader::DispatchArguments), kArgumentsUsage}
        ),
        graph.createBuffer(
            "bright regions",
            {sizeof(shader::RegionHeader) + regions * sizeof(uint32_t), kListUsage}
        ),
        graph.createBuffer(
            "bright region arguments", {sizeof(shader::DispatchArguments), kArgumentsUsage}
        )};
    clears.add(buffers.counts, 0);
    clears.addHead(buffers.regions, sizeof(shader::RegionHeader));
    for (const graph::BufferHandle arguments : {buffers.arguments, buffers.search})
        clears.addArguments(arguments, 1);
    return buffers;
}

BrightPointBuffers BrightPoints::getCleared(const BrightPointBuffers& made, const Clears& clears) {
    return {
        clears.get(made.counts),
        made.points,
        clears.get(made.arguments),
        clears.get(made.regions),
        clears.get(made.search)};
}

BrightPointBuffers BrightPoints::addRegions(
    graph::Graph& graph,
    graph::ImageHandle color,
    const BrightPointBuffers& buffers,
    const PassParams& params
) const {
    return graph.addPass<BrightPointBuffers>(
        "find bright regions",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, BrightPointBuffers& data) {
            builder.read(color, Access::SampledCompute);
            data = buffers;
            data.counts = builder.write(buffers.counts, Access::StorageWrite);
            data.regions = builder.write(buffers.regions, Access::StorageWrite);
            data.search = builder.write(buffers.search, Access::StorageWrite);
        },
        [this, color, params](const BrightPointBuffers& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            bindings.sampled(resources.view(color), mSampler)
                .buffer(resources.buffer(data.counts))
                .buffer(resources.buffer(data.regions))
                .buffer(resources.buffer(data.search));
            const glm::uvec2 threads =
                (params.sizePx + shader::kPointTilePx - 1u) / shader::kPointTilePx;
            dispatchPixels(context, mRegions.get(), bindings, params, threads);
        }
    );
}

BrightPointOutputs BrightPoints::add(
    graph::Graph& graph,
    graph::ImageHandle color,
    const SurfaceLayer& raster,
    const BrightPointBuffers& cleared,
    const PassParams& params
) const {
    const graph::ImageHandle copy = addCopy(graph, color);
    const BrightPointBuffers buffers = addRegions(graph, raster.color, cleared, params);
    return graph.addPass<BrightPointOutputs>(
        "find bright points",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, BrightPointOutputs& data) {
            builder.read(raster.color, Access::SampledCompute);
            builder.read(raster.surface, Access::SampledCompute);
            data.color = builder.write(copy, Access::StorageWrite);
            data.buffers = {
                builder.write(buffers.counts, Access::StorageWrite),
                builder.write(buffers.points, Access::StorageWrite),
                builder.write(buffers.arguments, Access::StorageWrite),
                builder.read(buffers.regions, Access::StorageRead),
                builder.read(buffers.search, Access::IndirectRead)};
        },
        [this, raster, params](const BrightPointOutputs& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            bindings.sampled(resources.view(raster.color), mSampler)
                .sampled(resources.view(raster.surface), mSampler)
                .storage(resources.image(data.color))
                .buffer(resources.buffer(data.buffers.counts))
                .buffer(resources.buffer(data.buffers.points))
                .buffer(resources.buffer(data.buffers.arguments))
                .buffer(resources.buffer(data.buffers.regions));
            dispatchList(context, mPoints.get(), bindings, params, data.buffers.search, 0);
        }
    );
}

} // namespace shutter::motion_blur
