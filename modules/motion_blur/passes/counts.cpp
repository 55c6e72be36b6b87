// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/counts.h"

#include "spirv/motion_blur/count_alone.comp.h"
#include "spirv/motion_blur/count_raster.comp.h"
#include "spirv/motion_blur/count_revealed.comp.h"
#include "spirv/motion_blur/find_jumps.comp.h"
#include "spirv/motion_blur/list_missing.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

#include <array>

namespace shutter::motion_blur {

namespace {

using graph::Access;

/// \param constants the list's number, then the shader's own
gpu::ComputePipelineDesc describeOverList(
    std::string name,
    std::span<const uint32_t> spirv,
    std::vector<VkDescriptorType> bindings,
    std::vector<uint32_t> constants
) {
    gpu::ComputePipelineDesc desc = describePass(std::move(name), spirv, std::move(bindings));
    desc.specialization = std::move(constants);
    return desc;
}

} // namespace

Counts::Counts(gpu::Device& device)
    : mSampler(device.nearestSampler()),
      mAlone(
          device, shader::kMixedList, {"count alone", motion_blur_count_alone_comp, 3, {0}, true}
      ),
      mJumps(
          device,
          describeOverList(
              "find jumps",
              motion_blur_find_jumps_comp,
              {kSampled, kSampled, kStorage, kBuffer},
              {shader::kCandidateList}
          )
      ),
      mCandidates(
          device,
          describeOverList(
              "count",
              motion_blur_count_raster_comp,
              {kSampled,
               kSampled,
               kSampled,
               kSampled,
               kSampled,
               kStorage,
               kStorage,
               kStorage,
               kBuffer,
               kBuffer,
               kBuffer},
              {shader::kCandidateList, 0}
          ),
          chooseTapVariants(device)
      ),
      mMask(
          device,
          describeOverList(
              "list missing",
              motion_blur_list_missing_comp,
              {kSampled, kStorage, kBuffer, kBuffer, kBuffer},
              {shader::kMaskedList,
               chooseMaskListing(device) == MaskListing::BlockByBlock ? 1u : 0u}
          )
      ),
      mRevealed(
          device,
          shader::kMaskedList,
          {"count revealed", motion_blur_count_revealed_comp, 8, {0}, true}
      ) {}

ClearedCounts Counts::create(graph::Graph& graph, const PassParams& params, Clears& clears) {
    const glm::uvec2 blocks = countBlocks(params);
    const ClearedCounts created{
        graph.createImage("jumps", {blocks.x, blocks.y, VK_FORMAT_R32_UINT}),
        MaskedPixels::create(graph, params, clears)};
    clears.add(created.jumps);
    return created;
}

ClearedCounts Counts::getCleared(const ClearedCounts& created, const Clears& clears) {
    return {clears.get(created.jumps), MaskedPixels::getCleared(created.masked, clears)};
}

CountedRaster Counts::addRaster(
    graph::Graph& graph,
    const CountInputs& inputs,
    const SortedBlocks& blocks,
    const ClearedCounts& empty,
    graph::ImageHandle target,
    const PassParams& params
) const {
    const std::array raster{inputs.color, inputs.motionDepth, inputs.entityId};
    CountedRaster counted;
    counted.target = mAlone.add(graph, raster, blocks.lists, target, params);
    counted.masked = empty.masked;
    counted.blocks = blocks;
    const auto jumps = addJumps(graph, inputs, blocks.candidates, empty.jumps, params);
    addCandidates(graph, inputs, jumps, params, counted);
    addMask(graph, params, counted);
    return counted;
}

graph::ImageHandle Counts::addJumps(
    graph::Graph& graph,
    const CountInputs& inputs,
    const BlockLists& candidates,
    graph::ImageHandle empty,
    const PassParams& params
) const {
    struct Data {
        std::array<graph::ImageHandle, 2> in;
        BlockLists candidates;
        graph::ImageHandle jumps;
    };

    return graph
        .addPass<Data>(
            "find jumps",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                data.in = {inputs.motionDepth, inputs.entityId};
                for (const graph::ImageHandle image : data.in)
                    builder.read(image, Access::SampledCompute);
                data.candidates = readList(builder, candidates);
                data.jumps = builder.write(empty, Access::StorageWrite);
            },
            [this, params](const Data& data, graph::PassContext& context) {
                const graph::PassResources& resources = context.resources;
                gpu::BindingList bindings;
                for (const graph::ImageHandle image : data.in)
                    bindings.sampled(resources.view(image), mSampler);
                bindings.storage(resources.image(data.jumps))
                    .buffer(resources.buffer(data.candidates.blocks));
                dispatchList(
                    context,
                    mJumps.get(),
                    bindings,
                    params,
                    data.candidates.arguments,
                    shader::kCandidateList
                );
            }
        )
        .jumps;
}

void Counts::addCandidates(
    graph::Graph& graph,
    const CountInputs& inputs,
    graph::ImageHandle jumps,
    const PassParams& params,
    CountedRaster& counted
) const {
    struct Data {
        std::array<graph::ImageHandle, 5> in;
        SortedBlocks blocks;
        std::array<graph::ImageHandle, 3> out;
    };

    const glm::uvec2 size = params.sizePx;
    const Data& pass = graph.addPass<Data>(
        "count",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.in = {inputs.color, inputs.motionDepth, inputs.dominant, inputs.entityId, jumps};
            for (const graph::ImageHandle image : data.in)
                builder.read(image, Access::SampledCompute);
            data.blocks = writeMasked(builder, counted.blocks);
            data.out = {
                builder.write(counted.target, Access::StorageWriteDisjoint),
                builder.write(
                    graph.createImage("seen", {size.x, size.y, VK_FORMAT_R16G16B16A16_SFLOAT}),
                    Access::StorageWrite
                ),
                builder.write(
                    graph.createImage("missing taps", {size.x, size.y, VK_FORMAT_R32_UINT}),
                    Access::StorageWrite
                )};
        },
        [this, params](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            for (const graph::ImageHandle image : data.in)
                bindings.sampled(resources.view(image), mSampler);
            for (const graph::ImageHandle image : data.out)
                bindings.storage(resources.image(image));
            bindings.buffer(resources.buffer(data.blocks.candidates.blocks))
                .buffer(resources.buffer(data.blocks.lists.blocks))
                .buffer(resources.buffer(data.blocks.lists.arguments));
            dispatchList(
                context,
                mCandidates.find(params),
                bindings,
                params,
                data.blocks.candidates.arguments,
                shader::kCandidateList
            );
        }
    );
    counted.target = pass.out[0];
    counted.seen = pass.out[1];
    counted.missing = pass.out[2];
    counted.blocks = pass.blocks;
}

void Counts::addMask(graph::Graph& graph, const PassParams& params, CountedRaster& counted) const {
    struct Data {
        graph::ImageHandle missing;
        BlockLists lists;
        MaskedPixels masked;
    };

    const Data& pass = graph.addPass<Data>(
        "list missing",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.missing = builder.read(counted.missing, Access::SampledCompute);
            data.lists = readList(builder, counted.blocks.lists);
            data.masked = {
                builder.write(counted.masked.mask, Access::StorageWrite),
                builder.write(counted.masked.list, Access::StorageWrite),
                builder.write(counted.masked.arguments, Access::StorageWrite)};
        },
        [this, params](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            bindings.sampled(resources.view(data.missing), mSampler)
                .storage(resources.image(data.masked.mask))
                .buffer(resources.buffer(data.lists.blocks))
                .buffer(resources.buffer(data.masked.list))
                .buffer(resources.buffer(data.masked.arguments));
            dispatchList(
                context, mMask.get(), bindings, params, data.lists.arguments, shader::kMaskedList
            );
        }
    );
    counted.masked = pass.masked;
}

graph::ImageHandle Counts::addRevealed(
    graph::Graph& graph,
    const CountInputs& inputs,
    const CountedRaster& counted,
    const RayRevealOutputs& reveal,
    const PassParams& params
) const {
    const std::array both{
        inputs.color,
        inputs.entityId,
        reveal.color,
        reveal.motionDepth,
        reveal.entityId,
        counted.masked.mask,
        counted.seen,
        counted.missing};
    return mRevealed.add(graph, both, counted.blocks.lists, counted.target, params);
}

} // namespace shutter::motion_blur
