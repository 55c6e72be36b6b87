// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/candidate_lists.h"

#include "spirv/motion_blur/resolved_candidates.comp.h"

#include "modules/motion_blur/passes/dispatch.h"
#include "shaders/motion_blur/resolved_parts_shared.h"
#include "shaders/motion_blur/resolved_shared.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

const char* namePass(LayerIndex layer) {
    switch (layer) {
    case LayerIndex::Raster:
        return "list candidates";
    case LayerIndex::Last:
        return "list candidates, last frame";
    case LayerIndex::Second:
        break;
    }
    return "list candidates, second raster";
}

gpu::ComputePipelineDesc describeList(const gpu::Device& device, LayerIndex layer, bool hasEdges) {
    gpu::ComputePipelineDesc desc = describePass(
        namePass(layer),
        motion_blur_resolved_candidates_comp,
        {kSampled, kBuffer, kBuffer, kBuffer, kBuffer, kSampled}
    );
    // A software device runs a group's threads in turn, and each waits at the barriers.
    const uint32_t rows = isSoftware(device) ? 2u : shader::kGroupSize;
    desc.specialization = {static_cast<uint32_t>(layer), rows, rows, hasEdges ? 1u : 0u};
    return desc;
}

} // namespace

CandidateLists::CandidateLists(gpu::Device& device)
    : mSampler(device.nearestSampler()),
      mPipelines{
          gpu::LazyPipeline(device, describeList(device, LayerIndex::Raster, false)),
          gpu::LazyPipeline(device, describeList(device, LayerIndex::Last, false)),
          gpu::LazyPipeline(device, describeList(device, LayerIndex::Second, false))},
      mWithEdges(device, describeList(device, LayerIndex::Raster, true)) {}

graph::BufferHandle
CandidateLists::create(graph::Graph& graph, const PassParams& params, Clears& clears) {
    const glm::uvec2 tiles = countCandidateTiles(params);
    const VkDeviceSize bytes = VkDeviceSize(tiles.x) * tiles.y * sizeof(shader::TileCandidates);
    const graph::BufferHandle lists = graph.createBuffer("candidates", {bytes, kListUsage});
    clears.add(lists, 0xFFFFFFFFu);
    return lists;
}

DeformingTiles
CandidateLists::createDeforming(graph::Graph& graph, const PassParams& params, Clears& clears) {
    const glm::uvec2 tiles = countCandidateTiles(params);
    const VkDeviceSize bytes =
        sizeof(shader::DeformingHeader) + VkDeviceSize(tiles.x) * tiles.y * sizeof(uint32_t);
    const DeformingTiles deforming{
        graph.createBuffer("deforming tiles", {bytes, kListUsage}),
        graph.createBuffer(
            "deforming tile arguments", {sizeof(shader::DispatchArguments), kArgumentsUsage}
        )};
    clears.addHead(deforming.tiles, sizeof(shader::DeformingHeader));
    clears.addArguments(deforming.arguments, 1);
    return deforming;
}

CandidateOutputs CandidateLists::add(
    graph::Graph& graph, const CandidateInputs& inputs, LayerIndex layer, const PassParams& params
) const {
    const glm::uvec2 tiles = countCandidateTiles(params);
    return graph.addPass<CandidateOutputs>(
        namePass(layer),
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, CandidateOutputs& data) {
            builder.read(inputs.surface, Access::SampledCompute);
            if (inputs.edgeSurface.isValid())
                builder.read(inputs.edgeSurface, Access::SampledCompute);
            data.candidates = builder.write(inputs.empty, Access::StorageWrite);
            if (inputs.deforming.tiles.isValid())
                data.deforming = {
                    builder.write(inputs.deforming.tiles, Access::StorageWrite),
                    builder.write(inputs.deforming.arguments, Access::StorageWrite)};
            if (inputs.crowds.tiles.isValid())
                data.crowds = {
                    builder.write(inputs.crowds.tiles, Access::StorageWrite),
                    builder.write(inputs.crowds.arguments, Access::StorageWrite)};
        },
        [this, inputs, layer, params, tiles](
            const CandidateOutputs& data, graph::PassContext& context
        ) {
            const graph::PassResources& resources = context.resources;
            // Unused bindings still need a valid descriptor.
            const DeformingTiles deforming = data.deforming.tiles.isValid()
                                                 ? data.deforming
                                                 : DeformingTiles{data.candidates, data.candidates};
            const bool mayCrowd = data.crowds.tiles.isValid();
            const bool hasEdges = inputs.edgeSurface.isValid();
            gpu::BindingList bindings;
            bindings.sampled(resources.view(inputs.surface), mSampler)
                .buffer(resources.buffer(deforming.arguments))
                .buffer(resources.buffer(data.candidates))
                .buffer(resources.buffer(mayCrowd ? data.crowds.arguments : data.candidates))
                .buffer(resources.buffer(deforming.tiles))
                .sampled(resources.view(hasEdges ? inputs.edgeSurface : inputs.surface), mSampler);
            const PassParams own = withCrowds(params, resources, data.crowds.tiles);
            const gpu::LazyPipeline& pipeline =
                hasEdges ? mWithEdges : mPipelines.at(static_cast<size_t>(layer));
            context.frame.bind(pipeline.get(), bindings, &own, sizeof(own));
            vkCmdDispatch(context.commands, tiles.x, tiles.y, 1);
        }
    );
}

} // namespace shutter::motion_blur
