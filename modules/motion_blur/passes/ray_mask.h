// SPDX-License-Identifier: MIT
// Where a background is about to come into sight (Tan et al., "Ray Mask"): mesh id and depth one
// motion away, 5x5 Sobel edge, range check. In blocks where that is possible only.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/clears.h"
#include "modules/motion_blur/passes/masked_pixels.h"

#include <cstdint>

namespace shutter::motion_blur {

struct RayMaskInputs {
    graph::ImageHandle motionDepth;
    graph::ImageHandle normal;
    graph::ImageHandle entityId;
    SortedBlocks blocks; ///< sorted for a mask
    bool measureEverywhere = false;
};

struct RayMaskOutputs {
    graph::ImageHandle edge; ///< RGBA8: candidate, measure, edge; drawn only if it is read
    MaskedPixels masked;
    SortedBlocks blocks;               ///< with kMaskedList, and candidates flagged
    graph::BufferHandle tiles;         ///< TileHeader, then the tiles with masked pixels
    graph::BufferHandle tileArguments; ///< DispatchArguments: a group a tile, 64 tiles a group
};

/// What the ray mask writes, with nothing in it.
struct ClearedMask {
    graph::ImageHandle edges;
    graph::ImageHandle edgeBlocks;
    MaskedPixels masked;
    graph::BufferHandle tiles;
    graph::BufferHandle tileArguments;
};

class RayMask {
  public:
    explicit RayMask(gpu::Device& device); ///< the listing that is faster on the device
    RayMask(gpu::Device& device, MaskListing listing);

    /// What nothing has written, to be cleared with other lists.
    [[nodiscard]] static ClearedMask
    create(graph::Graph& graph, const PassParams& params, Clears& clears);

    /// \param created of create() \param clears after Clears::declare()
    [[nodiscard]] static ClearedMask getCleared(const ClearedMask& created, const Clears& clears);

    /// \param empty of getCleared()
    [[nodiscard]] RayMaskOutputs
    add(graph::Graph& graph,
        const RayMaskInputs& inputs,
        const ClearedMask& empty,
        const PassParams& params) const;

    /// The same with lists that it clears itself.
    RayMaskOutputs
    add(graph::Graph& graph, const RayMaskInputs& inputs, const PassParams& params) const;

    /// The first two tests, to look at: drawn only if it is read.
    graph::ImageHandle
    addEdgeView(graph::Graph& graph, const RayMaskInputs& inputs, const PassParams& params) const;

  private:
    struct Edges {
        graph::ImageHandle edges;  ///< R8
        graph::ImageHandle blocks; ///< R8, one texel a block: an edge lies within a block's length
    };

    Edges addEdges(
        graph::Graph& graph,
        const RayMaskInputs& inputs,
        const Edges& cleared,
        const PassParams& params
    ) const;

    VkSampler mSampler;
    gpu::LazyPipeline mEdge;
    gpu::LazyPipeline mEdgeView;
    gpu::LazyPipeline mEdgeViewEverywhere;
    gpu::LazyPipeline mMask;
};

} // namespace shutter::motion_blur
