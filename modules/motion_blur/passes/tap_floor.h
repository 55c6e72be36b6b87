// SPDX-License-Identifier: MIT
// The floor under a gather's time: the same fetches at the same places in the same blocks,
// averaged. A benchmark's measure; its picture means nothing.
#pragma once

#include "modules/motion_blur/passes/filter.h"

namespace shutter::motion_blur {

struct TapFloorInputs {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle dominant;
};

class TapFloor {
  public:
    explicit TapFloor(gpu::Device& device);

    /// Over the blocks of mixed motion, as the pass "gather"; its own pass is "gather floor".
    /// \return a picture of the colour's size and format; mark it as an output, or nothing runs
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph,
        const TapFloorInputs& inputs,
        const BlockLists& lists,
        const PassParams& params) const;

  private:
    BlockFilter mFilter;
};

} // namespace shutter::motion_blur
