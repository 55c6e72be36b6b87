// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/deforming_parts.h"

#include "spirv/motion_blur/resolved_parts.comp.h"

#include "modules/motion_blur/passes/dispatch.h"
#include "shaders/motion_blur/resolved_parts_shared.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

const char* nameFind(LayerIndex layer) {
    switch (layer) {
    case LayerIndex::Raster:
        return "find parts";
    case LayerIndex::Last:
        return "find parts, last frame";
    case LayerIndex::Second:
        break;
    }
    return "find parts, second raster";
}

gpu::ComputePipelineDesc describeFind(const gpu::Device& device, LayerIndex layer) {
    gpu::ComputePipelineDesc desc = describePass(
        nameFind(layer),
        motion_blur_resolved_parts_comp,
        {kSampled, kSampled, kBuffer, kBuffer, kBuffer, kBuffer, kSampled}
    );
    // As those that list candidates.
    const uint32_t rows = isSoftware(device) ? 2u : shader::kGroupSize;
    desc.specialization = {static_cast<uint32_t>(layer), rows, rows};
    return desc;
}

} // namespace

DeformingParts::DeformingParts(gpu::Device& device)
    : mSampler(device.nearestSampler()),
      mPipelines{
          gpu::LazyPipeline(device, describeFind(device, LayerIndex::Raster)),
          gpu::LazyPipeline(device, describeFind(device, LayerIndex::Last)),
          gpu::LazyPipeline(device, describeFind(device, LayerIndex::Second))} {}

graph::BufferHandle DeformingParts::create(graph::Graph& graph, const PassParams& params) {
    const glm::uvec2 tiles = countCandidateTiles(params);
    const VkDeviceSize count = VkDeviceSize(tiles.x) * tiles.y * shader::kPartsPerTile;
    return graph.createBuffer("parts", {count * sizeof(shader::TilePart), kListUsage});
}

PartOutputs DeformingParts::add(
    graph::Graph& graph, const PartInputs& inputs, LayerIndex layer, const PassParams& params
) const {
    struct Data {
        PartOutputs outputs;
        DeformingTiles tiles;
    };

    return graph
        .addPass<Data>(
            nameFind(layer),
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                builder.read(inputs.surface, Access::SampledCompute);
                builder.read(inputs.motion, Access::SampledCompute);
                if (inputs.ways.isValid())
                    builder.read(inputs.ways, Access::SampledCompute);
                data.tiles = {
                    builder.read(inputs.tiles.tiles, Access::StorageRead),
                    builder.read(inputs.tiles.arguments, Access::IndirectRead)};
                data.outputs.listed = inputs.listed;
                data.outputs.listed.candidates =
                    builder.write(inputs.listed.candidates, Access::StorageWrite);
                data.outputs.listed.crowds = {
                    builder.write(inputs.listed.crowds.tiles, Access::StorageWrite),
                    builder.write(inputs.listed.crowds.arguments, Access::StorageWrite)};
                data.outputs.parts = builder.write(inputs.parts, Access::StorageWrite);
            },
            [this, inputs, layer, params](const Data& data, graph::PassContext& context) {
                const graph::PassResources& resources = context.resources;
                gpu::BindingList bindings;
                bindings.sampled(resources.view(inputs.surface), mSampler)
                    .sampled(resources.view(inputs.motion), mSampler)
                    .buffer(resources.buffer(data.outputs.listed.candidates))
                    .buffer(resources.buffer(data.outputs.listed.crowds.arguments))
                    .buffer(resources.buffer(data.tiles.tiles))
                    .buffer(resources.buffer(data.outputs.parts))
                    .sampled(
                        resources.view(inputs.ways.isValid() ? inputs.ways : inputs.surface),
                        mSampler
                    );
                const gpu::LazyPipeline& pipeline = mPipelines.at(static_cast<size_t>(layer));
                const PassParams own =
                    withCrowds(params, resources, data.outputs.listed.crowds.tiles);
                dispatchList(context, pipeline.get(), bindings, own, data.tiles.arguments, 0);
            }
        )
        .outputs;
}

} // namespace shutter::motion_blur
