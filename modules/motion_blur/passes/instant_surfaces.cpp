// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/instant_surfaces.h"

#include "spirv/motion_blur/instant_surfaces.comp.h"

#include "engine/graph/execute.h"
#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describeSurfaces() {
    std::vector<VkDescriptorType> bindings = listSearchBindings();
    bindings.push_back(kBuffer);
    gpu::ComputePipelineDesc desc =
        describePass("instant surfaces", motion_blur_instant_surfaces_comp, std::move(bindings));
    desc.subgroupSize = kDivergingSubgroup;
    return desc;
}

/// A buffer whose head is written. \param mostBytes that a buffer may have
graph::BufferHandle
addHead(graph::Graph& graph, const shader::InstantSurfaces& wanted, VkDeviceSize mostBytes) {
    shader::InstantSurfaces allocated = wanted;
    allocated.sizePx = shader::sizeInSteps(wanted.sizePx);
    VkDeviceSize bytes = surfaceBytes(allocated);
    if (bytes > mostBytes)
        bytes = surfaceBytes(wanted);
    const graph::BufferHandle buffer =
        graph.createBuffer("instant surfaces", {bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});

    struct Data {
        graph::BufferHandle buffer;
    };

    return graph
        .addPass<Data>(
            "begin instant surfaces",
            graph::PassKind::Transfer,
            [&](graph::PassBuilder& builder, Data& data) {
                data.buffer = builder.write(buffer, Access::TransferWrite);
            },
            [wanted](const Data& data, graph::PassContext& context) {
                clearList(context, data.buffer, &wanted, sizeof(wanted));
            }
        )
        .buffer;
}

} // namespace

InstantSurfacesPass::InstantSurfacesPass(gpu::Device& device)
    : mDevice(device), mPipelines(device, describeSurfaces()) {}

void InstantSurfacesPass::add(
    graph::Graph& graph,
    std::span<const shader::InstantSurfaces> wanted,
    ResolvePassOutputs& found,
    const PassParams& params
) const {
    for (const shader::InstantSurfaces& one : wanted)
        addOne(graph, one, found, params);
}

void InstantSurfacesPass::addOne(
    graph::Graph& graph,
    const shader::InstantSurfaces& wanted,
    ResolvePassOutputs& found,
    const PassParams& params
) const {
    struct Data {
        SearchResources search;
        graph::ImageHandle picture; ///< bound, and not written
        graph::BufferHandle surfaces;
    };

    const graph::BufferHandle begun =
        addHead(graph, wanted, mDevice.limits().maxStorageBufferRange);
    const Data& pass = graph.addPass<Data>(
        "instant surfaces",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.search = found.search;
            data.search.use(builder);
            mPipelines.prepare(data.search, data.search.isGeneral);
            data.picture = builder.write(found.picture, Access::StorageWrite);
            data.surfaces = builder.write(begun, Access::StorageWrite);
        },
        [this, params, size = wanted.sizePx](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings = data.search.bind(resources, mDevice, data.picture);
            bindings.buffer(resources.buffer(data.surfaces));
            dispatchPixels(
                context,
                mPipelines.get(data.search, data.search.isGeneral),
                bindings,
                withCrowds(params, resources, data.search.crowds),
                size
            );
        }
    );
    found.search.counters = pass.search.counters;
    found.picture = pass.picture;
    found.surfaces.push_back(pass.surfaces);
}

} // namespace shutter::motion_blur
