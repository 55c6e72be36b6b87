// SPDX-License-Identifier: MIT
// Where the time of a filter over lists of blocks goes, as a picture.
#pragma once

#include "modules/motion_blur/passes/filter.h"

namespace shutter::motion_blur {

/// Fetches that a ray counts as: on lavapipe one coherent ray takes as long as ten pixels of a
/// gather of 15 taps of two fetches.
inline constexpr uint32_t kFetchesPerRay = 300;

class CostView {
  public:
    explicit CostView(gpu::Device& device);

    /// R32F: fetches per pixel, 0 where nothing moves. Drawn only if something reads it.
    /// \param mask of the ray mask; invalid: the method has none
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph,
        graph::ImageHandle motionDepth,
        graph::ImageHandle mask,
        const SortedBlocks& blocks,
        const PassParams& params) const;

  private:
    BlockFilter mUniform;
    BlockFilter mMixed;
    BlockFilter mCandidates;
    BlockFilter mMasked;
};

} // namespace shutter::motion_blur
