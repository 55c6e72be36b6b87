// SPDX-License-Identifier: MIT
// Looks up each pixel's sample at each instant, by the entities' motion, in this frame's raster and
// in others.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/passes/block_samples.h"
#include "modules/motion_blur/passes/bright_points.h"
#include "modules/motion_blur/passes/candidate_lists.h"
#include "modules/motion_blur/passes/crowds.h"
#include "modules/motion_blur/passes/deforming_parts.h"
#include "modules/motion_blur/passes/lens_filter.h"
#include "modules/motion_blur/passes/surface_layers.h"
#include "modules/motion_blur/shared_passes.h"
#include "shaders/motion_blur/resolved_shared.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace shutter::motion_blur {

/// What the search for a sample reads and counts into: bindings 0 to 22 of resolved_layers.glsl, of
/// which binding 5 is the picture.
struct SearchResources {
    SurfaceLayersOutputs layers;
    graph::ImageHandle motionDepth; ///< of this frame's raster
    graph::ImageHandle edgeSurface; ///< MotionBlurInputs::edgeSurface
    SortedCandidates candidates;
    graph::BufferHandle crowds;       ///< of Crowds; invalid: no tile can be crowded
    graph::BufferHandle blockSamples; ///< of BlockSamples
    // By LayerIndex; invalid: nothing deforms there.
    std::array<graph::BufferHandle, 3> parts; ///< of DeformingParts
    std::array<graph::ImageHandle, 3> ways;   ///< of DrawWays; invalid, too, without one
    graph::BufferHandle counters;             ///< shader::ResolvedCounters
    bool hasLens = false;                     ///< InstantMotions::hasLens
    bool isGeneral = false;                   ///< InstantMotions::isGeneral()
    bool filtersLens = false;                 ///< so does LensFilter

    /// Declares the reads; the counters are written.
    void use(graph::PassBuilder& builder);
    [[nodiscard]] gpu::BindingList bind(
        const graph::PassResources& resources, gpu::Device& device, graph::ImageHandle target
    ) const;
};

/// Pixels that have samples for rays.
struct ListedPixels {
    graph::BufferHandle pixels; ///< x | y << 16, classes (resolved_shared.h)
    graph::BufferHandle arguments;
};

/// The pipelines of a pass that searches.
class SearchPipelines {
  public:
    /// \param desc whose constants 2 to 7 are set here (resolved_layers.glsl)
    SearchPipelines(gpu::Device& device, const gpu::ComputePipelineDesc& desc);

    /// Starts to make the pipeline on a device that makes pipelines ahead.
    /// \param isGeneral pixels of general tiles are searched (InstantMotions::isGeneral())
    void prepare(const SearchResources& search, bool isGeneral) const {
        (void)find(search, isGeneral);
    }

    [[nodiscard]] const gpu::Pipeline& get(const SearchResources& search, bool isGeneral) const {
        return find(search, isGeneral).get();
    }

  private:
    [[nodiscard]] const gpu::LazyPipeline&
    find(const SearchResources& search, bool isGeneral) const;

    gpu::Device& mDevice;
    gpu::ComputePipelineDesc mDesc;
    /// On software devices: Mesa's compiler makes a search of `courtyard` that takes 28.7 ms
    /// without the code for what deforms, and 25.4 with it.
    bool mAlwaysHasParts;
    /// By what they are specialised for: of 64, a session uses two or three.
    mutable std::map<uint32_t, gpu::LazyPipeline> mPipelines;
};

struct ResolvePassOutputs {
    SearchResources search;
    SortedBlocks blocks;
    BrightPointBuffers points;                                ///< that LensDiscs draws
    ListedPixels listed;                                      ///< invalid unless pixels were listed
    graph::ImageHandle picture;                               ///< with all blocks that move written
    StaticPixelsBy stillPixelsBy = StaticPixelsBy::WholeCopy; ///< how `picture` gets the others
    std::vector<graph::BufferHandle> surfaces;                ///< MotionBlurOutputs::surfaces
};

class ResolvePass {
  public:
    ResolvePass(gpu::Device& device, bool listsPixels);

    /// \param params with shader::ResolvedParams as the method knows it; comes back with the rest
    /// of it, and with uniformMotionPx 0 where each pixel searches for itself
    [[nodiscard]] ResolvePassOutputs
    add(graph::Graph& graph,
        const MotionBlurInputs& inputs,
        const MotionBlurSettings& settings,
        PassParams& params,
        SharedPasses& shared);

    /// Completes the method after its last pass: adds static pixels to the picture, filters lens
    /// blur, and copies the counters for the CPU.
    [[nodiscard]] MotionBlurOutputs
    end(graph::Graph& graph,
        const MotionBlurInputs& inputs,
        const ResolvePassOutputs& found,
        const PassParams& params,
        SharedPasses& shared) const;

    void count(uint32_t slot, Counters& counters) const;

  private:
    void describeInstants(
        const MotionBlurInputs& inputs,
        const MotionBlurSettings& settings,
        shader::ResolvedParams& own
    );
    void readCounters(graph::Graph& graph, graph::BufferHandle counters, uint32_t slot) const;
    /// Nearest first.
    [[nodiscard]] SortedCandidates
    addSort(graph::Graph& graph, const SortedCandidates& listed, const PassParams& params) const;
    /// \param isGeneral the blocks of general tiles; otherwise those that see several planes
    void addResolve(
        graph::Graph& graph, ResolvePassOutputs& outputs, bool isGeneral, const PassParams& params
    ) const;

    bool mListsPixels;
    gpu::Device& mDevice;
    SurfaceLayers mLayers;
    CandidateLists mCandidates;
    Crowds mCrowds;
    DeformingParts mParts;
    BrightPoints mPoints;
    LensFilter mLensFilter;
    gpu::LazyPipeline mSort;
    BlockSamples mBlocks;
    SearchPipelines mResolve;
    gpu::Buffer mNoise;         ///< the mask; empty until a frame has noise
    gpu::Buffer mRead;          ///< shader::ResolvedCounters by slot
    uint64_t mHistoryBytes = 0; ///< of the frame declared last
};

/// Bindings 0 to 22 of a pipeline that searches.
[[nodiscard]] std::vector<VkDescriptorType> listSearchBindings();

} // namespace shutter::motion_blur
