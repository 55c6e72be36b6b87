// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/block_lists.h"

#include "spirv/motion_blur/classify_blocks.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

#include <array>
#include <cstring>

namespace shutter::motion_blur {

namespace {

using graph::Access;

gpu::ComputePipelineDesc describeSort(bool forMask) {
    gpu::ComputePipelineDesc desc = describePass(
        "sort blocks",
        motion_blur_classify_blocks_comp,
        {kSampled, kSampled, kBuffer, kBuffer, kBuffer, kBuffer}
    );
    desc.specialization = {forMask ? 1u : 0u};
    return desc;
}

/// \param room lists that the buffer has room for
BlockLists createLists(graph::Graph& graph, const char* name, uint32_t blockCount, uint32_t room) {
    const VkDeviceSize entries = VkDeviceSize(room) * blockCount;
    return {
        graph.createBuffer(
            name, {sizeof(shader::BlockHeader) + entries * sizeof(uint32_t), kListUsage}
        ),
        graph.createBuffer(
            fmt::format("{} arguments", name),
            {sizeof(shader::DispatchArguments) * room, kArgumentsUsage}
        )};
}

struct ClearData {
    std::array<BlockLists, 2> pairs;
};

/// Empty lists. The last dimension of every dispatch stays 1.
void addClear(graph::Graph& graph, SortedBlocks& sorted) {
    const ClearData& cleared = graph.addPass<ClearData>(
        "clear block lists",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, ClearData& data) {
            data.pairs = {sorted.lists, sorted.candidates};
            for (BlockLists& pair : data.pairs) {
                pair.blocks = builder.write(pair.blocks, Access::TransferWrite);
                pair.arguments = builder.write(pair.arguments, Access::TransferWrite);
            }
        },
        [](const ClearData& data, graph::PassContext& context) {
            const std::array<uint32_t, 2> rooms{shader::kListCount, 1u};
            for (size_t i = 0; i < data.pairs.size(); ++i) {
                const shader::BlockHeader header{};
                clearList(context, data.pairs[i].blocks, &header, sizeof(header));
                clearArguments(context, data.pairs[i].arguments, rooms[i]);
            }
        }
    );
    sorted = {cleared.pairs[0], cleared.pairs[1]};
}

} // namespace

BlockSorter::BlockSorter(gpu::Device& device)
    : mSampler(device.nearestSampler()), mSort(device, describeSort(false)),
      mSortForMask(device, describeSort(true)),
      mHeader(device, "block counters", sizeof(shader::BlockHeader), 0, gpu::MemoryUse::Readback) {
    std::memset(mHeader.mapped(), 0, sizeof(shader::BlockHeader));
}

SortedBlocks BlockSorter::add(
    graph::Graph& graph,
    const TileMotionOutputs& tiles,
    const shader::MotionBlurParams& params,
    bool forMask
) const {
    const glm::uvec2 extent = countBlocks(params);
    const uint32_t blockCount = extent.x * extent.y;
    SortedBlocks sorted{
        createLists(graph, "blocks", blockCount, shader::kListCount),
        createLists(graph, "candidate blocks", forMask ? blockCount : 1, 1)};
    addClear(graph, sorted);

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
            data.sorted = sorted;
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
            dispatchPixels(context, forMask ? mSortForMask : mSort, bindings, params, extent);
        }
    );
    return pass.sorted;
}

void BlockSorter::addCounters(
    graph::Graph& graph, const BlockLists& lists, const shader::MotionBlurParams& params
) {
    struct Data {
        graph::BufferHandle blocks;
        graph::BufferHandle header;
    };

    const glm::uvec2 extent = countBlocks(params);
    mBlockCount = extent.x * extent.y;
    const auto header = graph.importBuffer("block counters", mHeader.handle(), mHeader.bytes());
    graph.addPass<Data>(
        "read block counters",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Data& data) {
            data.blocks = builder.read(lists.blocks, Access::TransferRead);
            data.header = builder.write(header, Access::TransferWrite);
            graph.markOutput(data.header);
        },
        [](const Data& data, graph::PassContext& context) {
            const VkBufferCopy region{0, 0, sizeof(shader::BlockHeader)};
            vkCmdCopyBuffer(
                context.commands,
                context.resources.buffer(data.blocks),
                context.resources.buffer(data.header),
                1,
                &region
            );
        }
    );
}

BlockCounters BlockSorter::counters() const {
    shader::BlockHeader header;
    std::memcpy(&header, mHeader.mapped(), sizeof(header));
    BlockCounters counters{0, header.uniformCount, header.mixedCount, header.maskedCount};
    const uint32_t moving = counters.uniform + counters.mixed + counters.masked;
    counters.still = mBlockCount > moving ? mBlockCount - moving : 0;
    return counters;
}

} // namespace shutter::motion_blur
