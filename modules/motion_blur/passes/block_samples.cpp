// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/block_samples.h"

#include "spirv/motion_blur/resolved_looks.comp.h"
#include "spirv/motion_blur/resolved_planes.comp.h"
#include "spirv/motion_blur/resolved_uniform.comp.h"

#include "modules/motion_blur/passes/dispatch.h"
#include "shaders/motion_blur/resolved_shared.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describeResolve(const gpu::Device& device, bool hasLens) {
    gpu::ComputePipelineDesc desc = describePass(
        "resolve uniform", motion_blur_resolved_uniform_comp, {kSampled, kStorage, kBuffer, kBuffer}
    );
    // On a software device a thread processes a column of the block and reuses its loads.
    const uint32_t rows = isSoftware(device) ? 1u : shader::kGroupSize;
    desc.specialization = {shader::kUniformList, rows, rows, hasLens ? 1u : 0u};
    return desc;
}

/// Threads along each side of a block: on GPUs about as many in all as a block has instants, since
/// few blocks move and the instants of one take longest; software devices have no threads to spare.
uint32_t countThreadsAcross(const gpu::Device& device) {
    return isSoftware(device) ? 1 : 4;
}

gpu::ComputePipelineDesc
describeFind(const gpu::Device& device, bool sortsUniform, bool hasParts, bool hasLens) {
    gpu::ComputePipelineDesc desc = describePass(
        "find block samples",
        motion_blur_resolved_looks_comp,
        std::vector<VkDescriptorType>(11, kBuffer)
    );
    desc.specialization = {
        sortsUniform ? 1u : 0u,
        hasParts ? 1u : 0u,
        shader::kGroupSize / countThreadsAcross(device),
        hasLens ? 1u : 0u};
    desc.subgroupSize = kDivergingSubgroup;
    return desc;
}

bool hasLens(const PassParams& params) {
    return (params.getMethod<shader::ResolvedParams>().has & shader::kHasLensPlaces) != 0;
}

VkDeviceSize countAllBlocks(const PassParams& params) {
    const glm::uvec2 blocks = countBlocks(params);
    return VkDeviceSize(blocks.x) * blocks.y;
}

VkDeviceSize countBlockSampleBytes(const PassParams& params) {
    // looksPerBlock() of resolved.glsl
    const uint32_t blockSamples = hasLens(params)
                                      ? 2 * params.sampleCount
                                      : params.getMethod<shader::ResolvedParams>().instantCount;
    return countAllBlocks(params) * (VkDeviceSize(blockSamples) + 1) * sizeof(shader::BlockSample);
}

} // namespace

BlockSamples::BlockSamples(gpu::Device& device, bool sortsUniform)
    : mDevice(device),
      mFit(
          device,
          describePass("fit planes", motion_blur_resolved_planes_comp, {kSampled, kBuffer, kBuffer})
      ),
      mFind{
          {{device, describeFind(device, sortsUniform, false, false)},
           {device, describeFind(device, sortsUniform, true, false)},
           {device, describeFind(device, sortsUniform, false, true)},
           {device, describeFind(device, sortsUniform, true, true)}}},
      mResolve{
          {{device, describeResolve(device, false)}, {device, describeResolve(device, true)}}} {}

bool BlockSamples::canFind(const PassParams& params) const {
    return params.sampleCount <= shader::kMaxBlockSamples &&
           countBlockSampleBytes(params) <= mDevice.limits().maxStorageBufferRange;
}

graph::BufferHandle BlockSamples::addFit(
    graph::Graph& graph,
    const SurfaceLayer& raster,
    const TileInputs& tiles,
    const PassParams& params
) const {
    struct Data {
        TileInputs tiles;
        graph::BufferHandle planes;
    };

    const graph::BufferHandle planes = graph.createBuffer(
        "block planes", {countAllBlocks(params) * sizeof(shader::BlockPlane), kListUsage}
    );
    return graph
        .addPass<Data>(
            "fit planes",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                builder.read(raster.surface, Access::SampledCompute);
                data.tiles = tiles;
                builder.read(tiles.candidates.raster, Access::StorageRead);
                if (tiles.crowds.isValid())
                    builder.read(tiles.crowds, Access::StorageRead);
                data.planes = builder.write(planes, Access::StorageWrite);
            },
            [this,
             surface = raster.surface,
             params](const Data& data, graph::PassContext& context) {
                const graph::PassResources& resources = context.resources;
                gpu::BindingList bindings;
                bindings.sampled(resources.view(surface), mDevice.nearestSampler())
                    .buffer(resources.buffer(data.tiles.candidates.raster))
                    .buffer(resources.buffer(data.planes));
                const PassParams own = withCrowds(params, resources, data.tiles.crowds);
                dispatchPixels(context, mFit.get(), bindings, own, countBlocks(params));
            }
        )
        .planes;
}

BlockSampleOutputs BlockSamples::addFind(
    graph::Graph& graph,
    const SurfaceLayer& raster,
    const TileInputs& tiles,
    const SortedBlocks& empty,
    const PassParams& params
) const {
    struct Data {
        TileInputs tiles;
        graph::BufferHandle planes;
        BlockSampleOutputs sorted;
    };

    graph::BufferHandle planes;
    graph::BufferHandle blockSamples;
    if (params.uniformMotionPx > 0.0f) {
        planes = addFit(graph, raster, tiles, params);
        blockSamples =
            graph.createBuffer("block samples", {countBlockSampleBytes(params), kListUsage});
    }
    return graph
        .addPass<Data>(
            "find block samples",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                data.tiles = tiles;
                const SortedCandidates& layers = tiles.candidates;
                for (const graph::BufferHandle buffer :
                     {layers.raster, layers.second, layers.last, tiles.parts, tiles.crowds})
                    if (buffer.isValid())
                        builder.read(buffer, Access::StorageRead);
                if (planes.isValid()) {
                    data.planes = builder.read(planes, Access::StorageRead);
                    data.sorted.blockSamples = builder.write(blockSamples, Access::StorageWrite);
                }
                data.sorted.blocks = empty;
                BlockLists& lists = data.sorted.blocks.lists;
                lists.blocks = builder.write(lists.blocks, Access::StorageWrite);
                lists.arguments = builder.write(lists.arguments, Access::StorageWrite);
                data.sorted.counters = tiles.counters;
                if (!tiles.isGeneral)
                    return;
                BlockLists& general = data.sorted.blocks.candidates;
                general.blocks = builder.write(general.blocks, Access::StorageWrite);
                general.arguments = builder.write(general.arguments, Access::StorageWrite);
                data.sorted.counters = builder.write(tiles.counters, Access::StorageWrite);
            },
            [this, params](const Data& data, graph::PassContext& context) {
                const graph::PassResources& resources = context.resources;
                const BlockLists& lists = data.sorted.blocks.lists;
                // Unused bindings still need a valid descriptor.
                const bool hasPlanes = data.planes.isValid();
                const SortedCandidates& layers = data.tiles.candidates;
                const BlockLists& general =
                    data.tiles.isGeneral ? data.sorted.blocks.candidates : lists;
                gpu::BindingList bindings;
                for (const graph::BufferHandle buffer :
                     {layers.raster,
                      layers.last.isValid() ? layers.last : layers.raster,
                      hasPlanes ? data.planes : lists.blocks,
                      hasPlanes ? data.sorted.blockSamples : lists.blocks,
                      lists.blocks,
                      lists.arguments,
                      layers.second.isValid() ? layers.second : layers.raster,
                      data.tiles.parts.isValid() ? data.tiles.parts : layers.raster,
                      general.blocks,
                      general.arguments,
                      data.tiles.isGeneral ? data.sorted.counters : lists.blocks})
                    bindings.buffer(resources.buffer(buffer));
                const PassParams own = withCrowds(params, resources, data.tiles.crowds);
                const gpu::LazyPipeline& pipeline =
                    mFind.at((data.tiles.parts.isValid() ? 1 : 0) + (hasLens(params) ? 2 : 0));
                const glm::uvec2 threads = countBlocks(params) * countThreadsAcross(mDevice);
                dispatchPixels(context, pipeline.get(), bindings, own, threads);
            }
        )
        .sorted;
}

graph::ImageHandle BlockSamples::addResolve(
    graph::Graph& graph,
    const SurfaceLayer& raster,
    const SortedBlocks& blocks,
    graph::BufferHandle blockSamples,
    graph::ImageHandle target,
    const PassParams& params
) const {
    if (!blockSamples.isValid())
        return target;

    struct Data {
        BlockLists lists;
        graph::BufferHandle blockSamples;
        graph::ImageHandle target;
    };

    return graph
        .addPass<Data>(
            "resolve uniform",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                builder.read(raster.color, Access::SampledCompute);
                data.blockSamples = builder.read(blockSamples, Access::StorageRead);
                data.lists = {
                    builder.read(blocks.lists.blocks, Access::StorageRead),
                    builder.read(blocks.lists.arguments, Access::IndirectRead)};
                data.target = builder.write(target, Access::StorageWriteDisjoint);
            },
            [this, color = raster.color, params](const Data& data, graph::PassContext& context) {
                const graph::PassResources& resources = context.resources;
                gpu::BindingList bindings;
                bindings.sampled(resources.view(color), mDevice.linearSampler())
                    .storage(resources.image(data.target))
                    .buffer(resources.buffer(data.blockSamples))
                    .buffer(resources.buffer(data.lists.blocks));
                dispatchList(
                    context,
                    mResolve.at(hasLens(params) ? 1 : 0).get(),
                    bindings,
                    params,
                    data.lists.arguments,
                    shader::kUniformList
                );
            }
        )
        .target;
}

} // namespace shutter::motion_blur
