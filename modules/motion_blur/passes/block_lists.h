// SPDX-License-Identifier: MIT
// Sorts the picture's blocks of 8 x 8 pixels into lists by class; later passes are dispatched over
// the lists, without the CPU.
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/clears.h"
#include "modules/motion_blur/passes/tile_motion.h"

#include <array>
#include <cstdint>

namespace shutter::motion_blur {

/// Lists of blocks and the arguments of dispatches over them. The first of each pair starts with a
/// shader::BlockHeader, the second is shader::DispatchArguments for each list.
struct BlockLists {
    graph::BufferHandle blocks;
    graph::BufferHandle arguments;
};

struct SortedBlocks {
    BlockLists lists; ///< kUniformList, kMixedList, kStillList; after the ray mask kMaskedList
    /// kCandidateList: blocks for the ray mask to test; after the list a flag for each block of the
    /// picture, which the ray mask sets where it has masked pixels.
    BlockLists candidates;
};

/// Declares a pass that is dispatched over a list and reads it.
[[nodiscard]] BlockLists readList(graph::PassBuilder& builder, const BlockLists& list);

/// Declares a pass that is dispatched over the candidates, flags some of them and lists those.
[[nodiscard]] SortedBlocks writeMasked(graph::PassBuilder& builder, const SortedBlocks& blocks);

/// Blocks of a picture by class.
struct BlockCounters {
    uint32_t still = 0;   ///< neither read nor written
    uint32_t uniform = 0; ///< all motion around is the dominant one
    uint32_t mixed = 0;   ///< the full filter
    uint32_t masked = 0;  ///< the full filter over two layers
};

class BlockSorter {
  public:
    explicit BlockSorter(gpu::Device& device);

    /// Whether still blocks are in a list: GPUs copy them one by one. Software devices copy the
    /// whole picture faster.
    [[nodiscard]] static bool listsStill(const gpu::Device& device);

    /// Lists that nothing has written, to be cleared with others.
    /// \param forMask blocks that may have masked pixels go to the candidates
    [[nodiscard]] static SortedBlocks
    create(graph::Graph& graph, const PassParams& params, bool forMask, Clears& clears);

    /// \param created of create() \param clears after Clears::declare()
    [[nodiscard]] static SortedBlocks getCleared(const SortedBlocks& created, const Clears& clears);

    /// \param empty getCleared() of lists that were created with the same forMask
    [[nodiscard]] SortedBlocks
    add(graph::Graph& graph,
        const TileMotionOutputs& tiles,
        const SortedBlocks& empty,
        const PassParams& params,
        bool forMask) const;

    /// The same with lists that it clears itself.
    SortedBlocks
    add(graph::Graph& graph, const TileMotionOutputs& tiles, const PassParams& params, bool forMask
    ) const;

    /// Reads the lists' lengths back, once all passes that append are declared.
    /// \param slot of the frames in flight, below kMaxSlots
    void addCounters(
        graph::Graph& graph, const SortedBlocks& sorted, const PassParams& params, uint32_t slot = 0
    );

    /// Counts of the frame declared last for the slot, once the GPU is done with it; before the
    /// first all 0.
    [[nodiscard]] BlockCounters counters(uint32_t slot = 0) const;

  private:
    VkSampler mSampler;
    gpu::LazyPipeline mSort;
    gpu::LazyPipeline mSortForMask;
    gpu::Buffer mHeaders;                           ///< by slot: of the lists, of the candidates
    std::array<uint32_t, kMaxSlots> mBlockCounts{}; ///< by slot: of the picture
};

} // namespace shutter::motion_blur
