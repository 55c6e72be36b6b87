// SPDX-License-Identifier: MIT
// Filters of one pass: some pictures in, the filtered one out, over the whole picture or over one
// list of blocks. Methods without a second layer differ in their shader and its inputs.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/tap_pipelines.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shutter::motion_blur {

/// A compute shader that samples `inputCount` images at bindings 0, 1, ... and stores to the next.
struct FilterDesc {
    std::string name;
    std::span<const uint32_t> spirv;
    uint32_t inputCount = 0;
    std::vector<uint32_t> constants{}; ///< specialization constants, behind the list's
    bool hasTapConstants = false;      ///< then those of gather_taps.glsl
};

/// Filters the whole picture.
class ScreenFilter {
  public:
    ScreenFilter(gpu::Device& device, FilterDesc desc);

    /// \param inputs as many as the shader samples (CHECKed); the first is the colour, whose size
    /// and format the result has
    /// \param suffix of the pass's name, for a filter that runs more than once
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph,
        std::span<const graph::ImageHandle> inputs,
        const PassParams& params,
        const std::string& suffix = "") const;

  private:
    std::string mName;
    uint32_t mInputCount;
    VkSampler mSampler;
    gpu::LazyPipeline mPipeline;
};

/// Filters the blocks of one list; the shader has the lists at the binding after its output, and
/// the list's number as specialization constant 0 (block_list.glsl). Filters that write one target
/// after another run at once: no block is in two lists, and passes that iterate candidates must
/// skip masked ones.
class BlockFilter {
  public:
    /// \param list shader::kUniformList, ...
    BlockFilter(gpu::Device& device, uint32_t list, FilterDesc desc);
    /// \param taps for filters with tap constants
    BlockFilter(gpu::Device& device, uint32_t list, FilterDesc desc, TapVariants taps);

    /// \param inputs as many as the shader samples (CHECKed)
    /// \return target with the list's blocks written
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph,
        std::span<const graph::ImageHandle> inputs,
        const BlockLists& lists,
        graph::ImageHandle target,
        const PassParams& params) const;

  private:
    std::string mName;
    uint32_t mInputCount;
    uint32_t mList;
    VkSampler mSampler;
    TapPipelines mPipelines;
};

} // namespace shutter::motion_blur
