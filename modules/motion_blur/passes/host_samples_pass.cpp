// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/host_samples_pass.h"

#include "spirv/motion_blur/collect_samples.comp.h"
#include "spirv/motion_blur/list_samples.comp.h"

#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "modules/motion_blur/passes/dispatch.h"
#include "modules/motion_blur/passes/ray_reveal.h"
#include "shaders/motion_blur/host_samples_shared.h"

#include <cmath>
#include <cstddef>
#include <utility>

namespace shutter::motion_blur {

namespace {

using graph::Access;

gpu::ComputePipelineDesc
describeSamples(const char* name, std::span<const uint32_t> spirv, size_t bufferCount) {
    std::vector<VkDescriptorType> bindings = listSearchBindings();
    bindings.insert(bindings.end(), bufferCount, kBuffer);
    gpu::ComputePipelineDesc desc = describePass(name, spirv, std::move(bindings));
    return desc;
}

/// Samples are chosen individually, so that their number varies about the limit. Which of them were
/// left out of a full list would depend on the order of threads: eight standard deviations more
/// find room.
VkDeviceSize capacityOf(const PassParams& params) {
    const VkDeviceSize limit = params.getMethod<shader::ResolvedParams>().rayLimit;
    return limit + static_cast<VkDeviceSize>(8.0 * std::sqrt(double(limit))) + 1;
}

} // namespace

struct HostSamplesPass::Lists {
    graph::BufferHandle samples; ///< shader::SampleHeader, shader::RequestedSample
    graph::BufferHandle answers; ///< vec4 by sample
    graph::BufferHandle first;   ///< by listed pixel
    graph::BufferHandle groups;  ///< shader::DispatchArguments
    graph::BufferHandle places;  ///< vec2 by sample: of the lens; invalid: there is none
};

/// What both passes have that search as the resolve does, pixel by listed pixel.
struct HostSamplesPass::Searching {
    SearchResources search;
    ListedPixels listed;
    Lists lists;
    graph::ImageHandle picture;

    void use(graph::PassBuilder& builder, const ResolvePassOutputs& found) {
        search = found.search;
        search.use(builder);
        listed = {
            builder.read(found.listed.pixels, Access::StorageRead),
            builder.read(found.listed.arguments, Access::IndirectRead)};
        picture = builder.write(found.picture, Access::StorageWrite);
    }
};

HostSamplesPass::HostSamplesPass(gpu::Device& device)
    : mDevice(device),
      mList(device, describeSamples("list samples", motion_blur_list_samples_comp, 6)),
      mCollect(device, describeSamples("collect samples", motion_blur_collect_samples_comp, 4)) {}

void HostSamplesPass::add(
    graph::Graph& graph, const HostSamples& own, ResolvePassOutputs& found, const PassParams& params
) const {
    Lists lists = createLists(graph, params, found.search.hasLens);
    addList(graph, found, lists, params);
    addAnswer(graph, own, lists, params);
    addCollect(graph, found, lists, params);
}

HostSamplesPass::Lists
HostSamplesPass::createLists(graph::Graph& graph, const PassParams& params, bool hasLens) const {
    const VkDeviceSize pixels = VkDeviceSize(params.sizePx.x) * params.sizePx.y;
    const VkDeviceSize capacity = capacityOf(params);
    Lists lists;
    lists.samples = graph.createBuffer(
        "requested samples",
        {sizeof(shader::SampleHeader) + capacity * sizeof(shader::RequestedSample), kListUsage}
    );
    lists.answers = graph.createBuffer("answers", {capacity * sizeof(glm::vec4), kListUsage});
    lists.first = graph.createBuffer("first samples", {pixels * sizeof(uint32_t), kListUsage});
    lists.groups = graph.createBuffer(
        "requested sample groups", {sizeof(shader::DispatchArguments), kArgumentsUsage}
    );
    if (hasLens)
        lists.places =
            graph.createBuffer("lens places", {capacity * sizeof(glm::vec2), kListUsage});
    const Lists& cleared = graph.addPass<Lists>(
        "clear requested samples",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Lists& data) {
            data.samples = builder.write(lists.samples, Access::TransferWrite);
            data.groups = builder.write(lists.groups, Access::TransferWrite);
        },
        [capacity](const Lists& data, graph::PassContext& context) {
            const shader::SampleHeader none{0, 0, static_cast<uint32_t>(capacity), 0};
            clearList(context, data.samples, &none, sizeof(none));
            clearArguments(context, data.groups, 1);
        }
    );
    lists.samples = cleared.samples;
    lists.groups = cleared.groups;
    return lists;
}

void HostSamplesPass::addList(
    graph::Graph& graph, ResolvePassOutputs& found, Lists& lists, const PassParams& params
) const {
    const Searching& pass = graph.addPass<Searching>(
        "list samples",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Searching& data) {
            data.use(builder, found);
            mList.prepare(data.search, data.search.isGeneral);
            data.lists = {
                builder.write(lists.samples, Access::StorageWrite),
                builder.write(lists.answers, Access::StorageWrite),
                builder.write(lists.first, Access::StorageWrite),
                builder.write(lists.groups, Access::StorageWrite)};
            if (lists.places.isValid())
                data.lists.places = builder.write(lists.places, Access::StorageWrite);
        },
        [this, params](const Searching& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings = data.search.bind(resources, mDevice, data.picture);
            bindings.buffer(resources.buffer(data.listed.pixels));
            for (const graph::BufferHandle buffer :
                 {data.lists.samples, data.lists.answers, data.lists.first, data.lists.groups})
                bindings.buffer(resources.buffer(buffer));
            // Without a lens it is not written.
            const graph::BufferHandle places =
                data.lists.places.isValid() ? data.lists.places : data.lists.answers;
            bindings.buffer(resources.buffer(places));
            const PassParams own = withCrowds(params, resources, data.search.crowds);
            const gpu::Pipeline& pipeline = mList.get(data.search, data.search.isGeneral);
            dispatchList(context, pipeline, bindings, own, data.listed.arguments, 0);
        }
    );
    found.search.counters = pass.search.counters;
    found.picture = pass.picture;
    lists = pass.lists;
}

void HostSamplesPass::addAnswer(
    graph::Graph& graph, const HostSamples& own, Lists& lists, const PassParams& params
) const {
    struct Data {
        Lists lists;
        graph::BufferHandle launch;
    };

    static_assert(
        offsetof(shader::SampleHeader, listed) == offsetof(shader::MaskHeader, listedPixels),
        "addLaunchSize() reads the count of either list"
    );
    const graph::BufferHandle launch = own.byRayPipeline && mDevice.info().tracesIndirect
                                           ? addLaunchSize(graph, lists.samples)
                                           : graph::BufferHandle{};
    const VkDeviceSize capacity = capacityOf(params);
    const Data& pass = graph.addPass<Data>(
        "own samples",
        own.byRayPipeline ? graph::PassKind::RayTracing : graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.lists.samples = builder.read(lists.samples, Access::StorageRead);
            data.lists.groups = builder.read(lists.groups, Access::IndirectRead);
            data.lists.answers = builder.write(lists.answers, Access::StorageWrite);
            if (lists.places.isValid())
                data.lists.places = builder.read(lists.places, Access::StorageRead);
            if (launch.isValid())
                data.launch = builder.read(launch, Access::IndirectRead);
        },
        [&own, capacity, sizePx = params.sizePx](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            auto task = makeTask<SampleTask>(context.commands, sizePx);
            task.list = resources.buffer(data.lists.samples);
            task.listAddress = resources.address(data.lists.samples);
            task.listBytes =
                sizeof(shader::SampleHeader) + capacity * sizeof(shader::RequestedSample);
            task.groups = resources.buffer(data.lists.groups);
            if (data.launch.isValid()) {
                task.launch = resources.buffer(data.launch);
                task.launchAddress = resources.address(data.launch);
            }
            task.answers = resources.buffer(data.lists.answers);
            task.answersAddress = resources.address(data.lists.answers);
            task.answersBytes = capacity * sizeof(glm::vec4);
            if (data.lists.places.isValid()) {
                task.lensPlaces = resources.buffer(data.lists.places);
                task.lensPlacesAddress = resources.address(data.lists.places);
                task.lensPlacesBytes = capacity * sizeof(glm::vec2);
            }
            own.record(task);
        }
    );
    lists.answers = pass.lists.answers;
}

void HostSamplesPass::addCollect(
    graph::Graph& graph, ResolvePassOutputs& found, const Lists& lists, const PassParams& params
) const {
    const Searching& pass = graph.addPass<Searching>(
        "collect samples",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Searching& data) {
            data.use(builder, found);
            mCollect.prepare(data.search, data.search.isGeneral);
            data.lists.samples = builder.read(lists.samples, Access::StorageRead);
            data.lists.answers = builder.read(lists.answers, Access::StorageRead);
            data.lists.first = builder.read(lists.first, Access::StorageRead);
        },
        [this, params](const Searching& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings = data.search.bind(resources, mDevice, data.picture);
            for (const graph::BufferHandle buffer :
                 {data.listed.pixels, data.lists.samples, data.lists.answers, data.lists.first})
                bindings.buffer(resources.buffer(buffer));
            const PassParams own = withCrowds(params, resources, data.search.crowds);
            const gpu::Pipeline& pipeline = mCollect.get(data.search, data.search.isGeneral);
            dispatchList(context, pipeline, bindings, own, data.listed.arguments, 0);
        }
    );
    found.search.counters = pass.search.counters;
    found.picture = pass.picture;
}

} // namespace shutter::motion_blur
