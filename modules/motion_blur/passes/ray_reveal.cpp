// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/ray_reveal.h"

#include "spirv/motion_blur/reveal.comp.h"
#include "spirv/motion_blur/reveal.rahit.h"
#include "spirv/motion_blur/reveal.rchit.h"
#include "spirv/motion_blur/reveal.rgen.h"
#include "spirv/motion_blur/reveal.rmiss.h"
#include "spirv/motion_blur/reveal_sky.comp.h"

#include "engine/core/check.h"
#include "modules/motion_blur/passes/dispatch.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace shutter::motion_blur {

namespace {

gpu::ComputePipelineDesc describeReveal(VkDescriptorSetLayout sceneLayout, bool hasBlended) {
    gpu::ComputePipelineDesc desc = describePass(
        hasBlended ? "ray reveal through blended surfaces" : "ray reveal",
        motion_blur_reveal_comp,
        {kSampled,
         kSampled,
         kSampled,
         kSampled,
         kStorage,
         kStorage,
         kStorage,
         kBuffer,
         VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR}
    );
    desc.interface.sceneLayout = sceneLayout;
    desc.specialization = {hasBlended ? 1u : 0u};
    return desc;
}

gpu::ComputePipelineDesc describeSky() {
    return describePass(
        "sky reveal",
        motion_blur_reveal_sky_comp,
        {kSampled, kSampled, kSampled, kSampled, kStorage, kStorage, kStorage, kBuffer}
    );
}

gpu::RayPipelineDesc describeTracer(VkDescriptorSetLayout sceneLayout, bool hasBlended) {
    gpu::ComputePipelineDesc shared = describeReveal(sceneLayout, hasBlended);
    gpu::RayPipelineDesc desc;
    desc.name = shared.name;
    desc.raygenSpirv = motion_blur_reveal_rgen;
    desc.missSpirv = motion_blur_reveal_rmiss;
    desc.closestHitSpirv = motion_blur_reveal_rchit;
    desc.anyHitSpirv = motion_blur_reveal_rahit;
    desc.interface = std::move(shared.interface);
    desc.specialization = std::move(shared.specialization);
    return desc;
}

} // namespace

RayReveal::RayReveal(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
    : mDevice(device), mSampler(device.nearestSampler()), mSky(device, describeSky()),
      mHeaders(
          device,
          "ray mask counters",
          kMaxSlots * sizeof(shader::MaskHeader),
          0,
          gpu::MemoryUse::Readback
      ) {
    for (const bool hasBlended : {false, true})
        if (device.hasRayQuery())
            mPipelines.emplace_back(device, describeReveal(sceneLayout, hasBlended));
        else
            mPipelines.emplace_back(device, describeTracer(sceneLayout, hasBlended));
}

bool RayReveal::isReady() const {
    return !mDevice.makesPipelinesAhead() ||
           std::all_of(mPipelines.begin(), mPipelines.end(), [](const gpu::LazyPipeline& one) {
               return one.isReady();
           });
}

const gpu::Pipeline& RayReveal::findPipeline(const graph::RayScene& rays) {
    if (rays.tlas == VK_NULL_HANDLE)
        return mSky.get();
    if (mDevice.hasRayQuery())
        return mPipelines[rays.hasBlended].get();
    auto& tracer = mTracers[rays.hasBlended];
    if (!tracer)
        tracer.emplace(mDevice, mPipelines[rays.hasBlended].take());
    return tracer->pipeline();
}

RayRevealOutputs createRevealed(graph::Graph& graph, const RayRevealInputs& inputs) {
    const auto create = [&](const char* name, graph::ImageHandle like) {
        return graph.createImage(name, graph.describeImage(like));
    };
    return {
        create("reveal color", inputs.color),
        create("reveal motion depth", inputs.motionDepth),
        create("reveal entity id", inputs.entityId)};
}

graph::BufferHandle addLaunchSize(graph::Graph& graph, graph::BufferHandle list) {
    using graph::Access;

    struct Data {
        graph::BufferHandle list;
        graph::BufferHandle size;
    };

    const auto buffer = graph.createBuffer(
        "reveal launch",
        {sizeof(VkTraceRaysIndirectCommandKHR), VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT}
    );
    return graph
        .addPass<Data>(
            "size reveal launch",
            graph::PassKind::Transfer,
            [&](graph::PassBuilder& builder, Data& data) {
                data.list = builder.read(list, Access::TransferRead);
                data.size = builder.write(buffer, Access::TransferWrite);
            },
            [](const Data& data, graph::PassContext& context) {
                using Size = VkTraceRaysIndirectCommandKHR;
                const VkBuffer target = context.resources.buffer(data.size);
                const VkBufferCopy width{
                    offsetof(shader::MaskHeader, listedPixels),
                    offsetof(Size, width),
                    sizeof(Size::width)};
                vkCmdCopyBuffer(
                    context.commands, context.resources.buffer(data.list), target, 1, &width
                );
                const std::array<uint32_t, 2> heightDepth{1, 1};
                vkCmdUpdateBuffer(
                    context.commands,
                    target,
                    offsetof(Size, height),
                    sizeof(heightDepth),
                    heightDepth.data()
                );
            }
        )
        .size;
}

void RayReveal::launch(
    graph::PassContext& context,
    const RayRevealInputs& inputs,
    const PassParams& params,
    graph::BufferHandle launchSize
) const {
    const graph::PassResources& resources = context.resources;
    const gpu::RayPipeline& tracer = *mTracers[inputs.rays.hasBlended];
    if (launchSize.isValid())
        return tracer.traceIndirect(context.commands, resources.buffer(launchSize));
    tracer.trace(context.commands, params.sizePx.x, params.sizePx.y);
}

RayRevealOutputs
RayReveal::add(graph::Graph& graph, const RayRevealInputs& inputs, const PassParams& params) {
    using graph::Access;
    const RayRevealOutputs outputs = createRevealed(graph, inputs);
    const bool skyOnly = inputs.rays.tlas == VK_NULL_HANDLE;
    const bool byCompute = skyOnly || mDevice.hasRayQuery();
    // Where the device reads no launch's size from memory, there is a launch for every pixel.
    const graph::BufferHandle launchSize = byCompute || !mDevice.info().tracesIndirect
                                               ? graph::BufferHandle{}
                                               : addLaunchSize(graph, inputs.masked.list);
    const gpu::Pipeline& pipeline = findPipeline(inputs.rays);

    struct RevealData {
        RayRevealInputs in;
        RayRevealOutputs out;
        graph::BufferHandle list;
    };

    const RevealData& revealed = graph.addPass<RevealData>(
        skyOnly ? "sky reveal" : "ray reveal",
        byCompute ? graph::PassKind::Compute : graph::PassKind::RayTracing,
        [&](graph::PassBuilder& builder, RevealData& data) {
            data.in = inputs;
            if (!skyOnly)
                builder.read(inputs.rays.tlasBuffer, Access::AccelerationRead);
            if (inputs.rays.movingTlasBuffer.isValid())
                builder.read(inputs.rays.movingTlasBuffer, Access::AccelerationRead);
            if (inputs.rays.deformedBlasBuffer.isValid())
                builder.read(inputs.rays.deformedBlasBuffer, Access::AccelerationRead);
            if (inputs.rays.deformedBuffer.isValid())
                builder.read(inputs.rays.deformedBuffer, Access::ShaderRead);
            for (const graph::BufferHandle buffer : inputs.rays.shading)
                builder.read(buffer, Access::ShaderRead);
            builder.read(inputs.color, Access::SampledCompute);
            builder.read(inputs.motionDepth, Access::SampledCompute);
            builder.read(inputs.entityId, Access::SampledCompute);
            builder.read(inputs.masked.mask, Access::SampledCompute);
            data.out.color = builder.write(outputs.color, Access::StorageWrite);
            data.out.motionDepth = builder.write(outputs.motionDepth, Access::StorageWrite);
            data.out.entityId = builder.write(outputs.entityId, Access::StorageWrite);
            data.list = builder.write(inputs.masked.list, Access::StorageWrite);
            if (byCompute)
                builder.read(inputs.masked.arguments, Access::IndirectRead);
            else if (launchSize.isValid())
                builder.read(launchSize, Access::IndirectRead);
        },
        [this, params, byCompute, launchSize, &pipeline](
            const RevealData& data, graph::PassContext& context
        ) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            bindings.sampled(resources.view(data.in.color), mSampler)
                .sampled(resources.view(data.in.motionDepth), mSampler)
                .sampled(resources.view(data.in.entityId), mSampler)
                .sampled(resources.view(data.in.masked.mask), mSampler)
                .storage(resources.image(data.out.color))
                .storage(resources.image(data.out.motionDepth))
                .storage(resources.image(data.out.entityId))
                .buffer(resources.buffer(data.list));
            if (data.in.rays.tlas != VK_NULL_HANDLE)
                bindings.accelerationStructure(data.in.rays.tlas);
            context.frame.bind(pipeline, bindings, &params, sizeof(params), data.in.rays.textures);
            if (byCompute)
                vkCmdDispatchIndirect(
                    context.commands, resources.buffer(data.in.masked.arguments), 0
                );
            else
                launch(context, data.in, params, launchSize);
        }
    );

    SHUTTER_CHECK(inputs.slot < kMaxSlots, "slot {}", inputs.slot);
    mTraces.at(inputs.slot) = !skyOnly;
    if (inputs.wantsCounters)
        addCounters(graph, revealed.list, inputs.slot);
    return revealed.out;
}

void RayReveal::countOwn(graph::Graph& graph, graph::BufferHandle list, uint32_t slot) {
    mTraces.at(slot) = true;
    addCounters(graph, list, slot);
}

void RayReveal::addCounters(graph::Graph& graph, graph::BufferHandle list, uint32_t slot) const {
    using graph::Access;

    struct Data {
        graph::BufferHandle list;
        graph::BufferHandle header;
    };

    const VkDeviceSize headerAt = slot * sizeof(shader::MaskHeader);
    const auto header =
        graph.importBuffer("ray mask counters", mHeaders.handle(), mHeaders.bytes());
    graph.addPass<Data>(
        "read ray mask counters",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Data& data) {
            data.list = builder.read(list, Access::TransferRead);
            data.header = builder.write(header, Access::TransferWrite);
            graph.markOutput(data.header);
        },
        [headerAt](const Data& data, graph::PassContext& context) {
            const VkBufferCopy region{0, headerAt, sizeof(shader::MaskHeader)};
            vkCmdCopyBuffer(
                context.commands,
                context.resources.buffer(data.list),
                context.resources.buffer(data.header),
                1,
                &region
            );
        }
    );
}

RayReveal::Counts RayReveal::count(uint32_t slot) const {
    const auto& header = static_cast<const shader::MaskHeader*>(mHeaders.mapped())[slot];
    const uint32_t rays = header.listedPixels - header.raylessPixels + header.extraRays;
    return {header.listedPixels + header.sharingPixels, mTraces.at(slot) ? rays : 0};
}

} // namespace shutter::motion_blur
