// SPDX-License-Identifier: MIT
// Counts what each pixel saw (shaders/motion_blur/count_taps.glsl): first over the raster, which
// leaves out the taps that saw a background that it does not have; then, once that is revealed,
// those taps.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/clears.h"
#include "modules/motion_blur/passes/filter.h"
#include "modules/motion_blur/passes/masked_pixels.h"
#include "modules/motion_blur/passes/ray_reveal.h"
#include "modules/motion_blur/passes/tap_pipelines.h"

namespace shutter::motion_blur {

struct CountInputs {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle dominant;
    graph::ImageHandle entityId;
};

/// What the counts must find empty.
struct ClearedCounts {
    graph::ImageHandle jumps; ///< R32UI, one texel a block (jump.glsl)
    MaskedPixels masked;
};

struct CountedRaster {
    graph::ImageHandle target; ///< complete except at masked pixels
    MaskedPixels masked;       ///< those with missing taps
    SortedBlocks blocks;       ///< with kMaskedList, and candidates flagged
    graph::ImageHandle
        seen; ///< RGBA16F at masked pixels: mean without the missing taps, their share
    graph::ImageHandle missing; ///< R32UI in candidates: which taps (missing_taps.glsl)
};

class Counts {
  public:
    explicit Counts(gpu::Device& device);

    /// What nothing has written, to be cleared with other lists.
    [[nodiscard]] static ClearedCounts
    create(graph::Graph& graph, const PassParams& params, Clears& clears);

    /// \param created of create() \param clears after Clears::declare()
    [[nodiscard]] static ClearedCounts
    getCleared(const ClearedCounts& created, const Clears& clears);

    /// Counts mixed blocks and candidates; uniform blocks are the gather's.
    /// \param blocks sorted for a mask
    [[nodiscard]] CountedRaster addRaster(
        graph::Graph& graph,
        const CountInputs& inputs,
        const SortedBlocks& blocks,
        const ClearedCounts& empty,
        graph::ImageHandle target,
        const PassParams& params
    ) const;

    /// \return the target with masked pixels written
    [[nodiscard]] graph::ImageHandle addRevealed(
        graph::Graph& graph,
        const CountInputs& inputs,
        const CountedRaster& counted,
        const RayRevealOutputs& reveal,
        const PassParams& params
    ) const;

  private:
    graph::ImageHandle addJumps(
        graph::Graph& graph,
        const CountInputs& inputs,
        const BlockLists& candidates,
        graph::ImageHandle empty,
        const PassParams& params
    ) const;
    void addCandidates(
        graph::Graph& graph,
        const CountInputs& inputs,
        graph::ImageHandle jumps,
        const PassParams& params,
        CountedRaster& counted
    ) const;
    void addMask(graph::Graph& graph, const PassParams& params, CountedRaster& counted) const;

    VkSampler mSampler;
    BlockFilter mAlone;
    gpu::LazyPipeline mJumps;
    TapPipelines mCandidates;
    gpu::LazyPipeline mMask;
    BlockFilter mRevealed;
};

} // namespace shutter::motion_blur
