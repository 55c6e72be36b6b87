// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/block_lists.h"

#include "spirv/motion_blur/classify_blocks.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

#include <array>
#include <cstring>

namespace shutter::motion_blur {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describeSort(const gpu::Device& device, bool forMask) {
    gpu::ComputePipelineDesc desc = describePass(
        "sort blocks",
        motion_blur_classify_blocks_comp,
        {kSampled, kSampled, kBuffer, kBuffer, kBuffer, kBuffer}
    );
    desc.specialization = {forMask ? 1u : 0u, BlockSorter::listsStill(device) ? 1u : 0u};
    return desc;
}

/// \param words behind the head
BlockLists createLists(graph::Graph& graph, const char* name, VkDeviceSize words, uint32_t count) {
    return {
        graph.createBuffer(
            name, {sizeof(shader::BlockHeader) + words * sizeof(uint32_t), kListUsage}
        ),
        graph.createBuffer(
            fmt::format("{} arguments", name),
            {sizeof(shader::DispatchArguments) * count, kArgumentsUsage}
        )};
}

SortedBlocks createSorted(graph::Graph& graph, const PassParams& params, bool forMask) {
    const glm::uvec2 extent = countBlocks(params);
    const VkDeviceSize blockCount = VkDeviceSize(extent.x) * extent.y;
    return {
        createLists(graph, "blocks", shader::kListCount * blockCount, shader::kListCount),
        createLists(graph, "candidate blocks", forMask ? 2 * blockCount : 0, 1)};
}

/// Headers of one slot: the lists' and the candidates'.
constexpr VkDeviceSize kHeaderBytes = 2 * sizeof(shader::BlockHeader);

} // namespace

BlockLists readList(graph::PassBuilder& builder, const BlockLists& list) {
    return {
        builder.read(list.blocks, Access::StorageRead),
        builder.read(list.arguments, Access::IndirectRead)};
}

SortedBlocks writeMasked(graph::PassBuilder& builder, const SortedBlocks& blocks) {
    return {
        {builder.write(blocks.lists.blocks, Access::StorageWrite),
         builder.write(blocks.lists.arguments, Access::StorageWrite)},
        {builder.write(blocks.candidates.blocks, Access::StorageWrite),
         builder.read(blocks.candidates.arguments, Access::IndirectRead)}};
}

bool BlockSorter::listsStill(const gpu::Device& device) {
    return !isSoftware(device);
}

BlockSorter::BlockSorter(gpu::Device& device)
    : mSampler(device.nearestSampler()), mSort(device, describeSort(device, false)),
      mSortForMask(device, describeSort(device, true)),
      mHeaders(device, "block counters", kMaxSlots * kHeaderBytes, 0, gpu::MemoryUse::Readback) {
    mHeaders.writeZeros();
}

SortedBlocks
BlockSorter::create(graph::Graph& graph, const PassParams& params, bool forMask, Clears& clears) {
    SortedBlocks sorted = createSorted(graph, params, forMask);
    clears.addHead(sorted.lists.blocks, sizeof(shader::BlockHeader));
    clears.addArguments(sorted.lists.arguments, shader::kListCount);
    clears.add(sorted.candidates.blocks, 0); // no block is flagged
    clears.addArguments(sorted.candidates.arguments, 1);
    return sorted;
}

SortedBlocks BlockSorter::getCleared(const SortedBlocks& created, const Clears& clears) {
    const auto get = [&](const BlockLists& lists) {
        return BlockLists{clears.get(lists.blocks), clears.get(lists.arguments)};
    };
    return {get(created.lists), get(created.candidates)};
}

SortedBlocks BlockSorter::add(
    graph::Graph& graph, const TileMotionOutputs& tiles, const PassParams& params, bool forMask
) const {
    Clears clears;
    const SortedBlocks created = create(graph, params, forMask, clears);
    clears.declare(graph);
    return add(graph, tiles, getCleared(created, clears), params, forMask);
}

SortedBlocks BlockSorter::add(
    graph::Graph& graph,
    const TileMotionOutputs& tiles,
    const SortedBlocks& empty,
    const PassParams& params,
    bool forMask
) const {
    const glm::uvec2 extent = countBlocks(params);

    struct Data {
        TileMotionOutputs tiles;
        SortedBlocks sorted;
    };

    const Data& pass = graph.addPass<Data>(
        "sort blocks",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.tiles = tiles;
            builder.read(tiles.tiles, Access::SampledCompute);
            builder.read(tiles.tileClass, Access::SampledCompute);
            data.sorted = empty;
            for (BlockLists* pair : {&data.sorted.lists, &data.sorted.candidates}) {
                pair->blocks = builder.write(pair->blocks, Access::StorageWrite);
                pair->arguments = builder.write(pair->arguments, Access::StorageWrite);
            }
        },
        [this, params, extent, forMask](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            bindings.sampled(resources.view(data.tiles.tiles), mSampler)
                .sampled(resources.view(data.tiles.tileClass), mSampler);
            for (const BlockLists* pair : {&data.sorted.lists, &data.sorted.candidates})
                bindings.buffer(resources.buffer(pair->blocks))
                    .buffer(resources.buffer(pair->arguments));
            dispatchPixels(
                context, (forMask ? mSortForMask : mSort).get(), bindings, params, extent
            );
        }
    );
    return pass.sorted;
}

void BlockSorter::addCounters(
    graph::Graph& graph, const SortedBlocks& sorted, const PassParams& params, uint32_t slot
) {
    struct Data {
        std::array<graph::BufferHandle, 2> blocks;
        graph::BufferHandle headers;
    };

    const glm::uvec2 extent = countBlocks(params);
    mBlockCounts.at(slot) = extent.x * extent.y;
    const auto headers = graph.importBuffer("block counters", mHeaders.handle(), mHeaders.bytes());
    graph.addPass<Data>(
        "read block counters",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Data& data) {
            data.blocks = {
                builder.read(sorted.lists.blocks, Access::TransferRead),
                builder.read(sorted.candidates.blocks, Access::TransferRead)};
            data.headers = builder.write(headers, Access::TransferWrite);
            graph.markOutput(data.headers);
        },
        [slot](const Data& data, graph::PassContext& context) {
            for (size_t i = 0; i < data.blocks.size(); ++i) {
                const VkDeviceSize bytes = sizeof(shader::BlockHeader);
                const VkBufferCopy region{0, slot * kHeaderBytes + i * bytes, bytes};
                vkCmdCopyBuffer(
                    context.commands,
                    context.resources.buffer(data.blocks[i]),
                    context.resources.buffer(data.headers),
                    1,
                    &region
                );
            }
        }
    );
}

BlockCounters BlockSorter::counters(uint32_t slot) const {
    const uint32_t blockCount = mBlockCounts.at(slot);
    std::array<shader::BlockHeader, 2> headers;
    std::memcpy(
        headers.data(),
        static_cast<const char*>(mHeaders.mapped()) + slot * kHeaderBytes,
        kHeaderBytes
    );
    const uint32_t candidates = headers[1].uniformCount; // kCandidateList is the first separate one
    const uint32_t moving = headers[0].uniformCount + headers[0].mixedCount + candidates;
    BlockCounters counters;
    counters.still = blockCount > moving ? blockCount - moving : 0;
    counters.uniform = headers[0].uniformCount;
    counters.masked = headers[0].maskedCount;
    counters.mixed = headers[0].mixedCount + candidates - counters.masked;
    return counters;
}

} // namespace shutter::motion_blur
