// SPDX-License-Identifier: MIT
// The gather of one or two layers and their composite by weights (Tan et al., "Post-process" and
// appendix), with a separate kernel for each class of blocks.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/filter.h"

#include <optional>

namespace shutter::motion_blur {

/// The background layer. Images hold masked pixels, `dominant` tiles that have some; elsewhere the
/// layer is the raster's.
struct RevealedLayer {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle dominant;
    graph::ImageHandle mask;
};

struct GatherInputs {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle dominant;
    std::optional<RevealedLayer> reveal{}; ///< none: the raster layer alone
};

class Gather {
  public:
    explicit Gather(gpu::Device& device);
    Gather(gpu::Device& device, TapVariants taps);

    /// Blocks of uniform motion alone.
    [[nodiscard]] graph::ImageHandle addUniform(
        graph::Graph& graph,
        const GatherInputs& inputs,
        const SortedBlocks& blocks,
        graph::ImageHandle target,
        const PassParams& params
    ) const;

    /// \return target with all listed blocks written
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph,
        const GatherInputs& inputs,
        const SortedBlocks& blocks,
        graph::ImageHandle target,
        const PassParams& params) const;

  private:
    BlockFilter mUniform;
    BlockFilter mOneLayer;
    BlockFilter mOneLayerOfCandidates;
    BlockFilter mTwoLayers;
};

} // namespace shutter::motion_blur
