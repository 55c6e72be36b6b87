// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/crowds.h"

#include "spirv/motion_blur/resolved_crowd_seeds.comp.h"

#include "modules/motion_blur/passes/candidate_lists.h"
#include "modules/motion_blur/passes/dispatch.h"
#include "shaders/motion_blur/resolved_shared.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

/// As in resolved_crowds.glsl.
uint32_t countLayers(const PassParams& params) {
    const uint32_t has = params.getMethod<shader::ResolvedParams>().has;
    if ((has & shader::kHasSecondLayer) != 0)
        return 3;
    return (has & shader::kHasLastLayer) != 0 ? 2 : 1;
}

} // namespace

PassParams withCrowds(
    const PassParams& params, const graph::PassResources& resources, graph::BufferHandle tiles
) {
    if (!tiles.isValid())
        return params;
    PassParams own = params;
    auto method = own.getMethod<shader::ResolvedParams>();
    method.crowds = gpu::splitAddress(resources.address(tiles));
    own.setMethod(method);
    return own;
}

Crowds::Crowds(gpu::Device& device)
    : mSampler(device.nearestSampler()), mPipeline(
                                             device,
                                             describePass(
                                                 "list crowds",
                                                 motion_blur_resolved_crowd_seeds_comp,
                                                 {kSampled, kSampled, kSampled, kSampled}
                                             )
                                         ) {}

CrowdBuffers Crowds::create(graph::Graph& graph, const PassParams& params, Clears& clears) {
    const glm::uvec2 tiles = countCandidateTiles(params);
    const VkDeviceSize count = VkDeviceSize(tiles.x) * tiles.y * countLayers(params);
    const CrowdBuffers buffers{
        graph.createBuffer("tile crowds", {count * sizeof(shader::TileCrowd), kListUsage}),
        graph.createBuffer(
            "tile crowd arguments", {sizeof(shader::DispatchArguments), kArgumentsUsage}
        )};
    clears.add(buffers.tiles, 0xFFFFFFFFu);
    clears.addArguments(buffers.arguments, 1);
    return buffers;
}

graph::BufferHandle Crowds::add(
    graph::Graph& graph,
    const SurfaceLayersOutputs& layers,
    graph::ImageHandle motionDepth,
    const CrowdBuffers& crowds,
    const PassParams& params
) const {
    struct Data {
        SurfaceLayersOutputs layers;
        CrowdBuffers crowds;
    };

    const Data& pass = graph.addPass<Data>(
        "list crowds",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.layers = layers;
            for (const SurfaceLayer& layer : {layers.raster, layers.last, layers.second})
                if (layer.surface.isValid())
                    builder.read(layer.surface, Access::SampledCompute);
            builder.read(motionDepth, Access::SampledCompute);
            data.crowds = {
                builder.write(crowds.tiles, Access::StorageWrite),
                builder.read(crowds.arguments, Access::IndirectRead)};
        },
        [this, motionDepth, params](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            for (const SurfaceLayer& layer :
                 {data.layers.raster, data.layers.last, data.layers.second}) {
                // Unused bindings still need a valid descriptor.
                const SurfaceLayer& bound = layer.surface.isValid() ? layer : data.layers.raster;
                bindings.sampled(resources.view(bound.surface), mSampler);
            }
            bindings.sampled(resources.view(motionDepth), mSampler);
            const PassParams own = withCrowds(params, resources, data.crowds.tiles);
            dispatchList(context, mPipeline.get(), bindings, own, data.crowds.arguments, 0);
        }
    );
    return pass.crowds.tiles;
}

} // namespace shutter::motion_blur
