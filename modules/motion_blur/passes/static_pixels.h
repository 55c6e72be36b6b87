// SPDX-License-Identifier: MIT
// How the blurred picture gets its static pixels, which no filter writes. Three ways with
// bit-identical pictures: the whole picture is copied and the filters write over the copy; or the
// filters write to a separate picture and their blocks are copied back, so that static pixels are
// not touched; or, if the sharp picture is stored for the next frame, the filters read the stored
// copy and write over the picture. The first costs the same whatever moves (1.1 ms at 1280x720 on
// lavapipe), the second in proportion to what moves (4 ms where all does), the third nothing.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/filter.h"

#include <cstdint>

namespace shutter::motion_blur {

enum class StaticPixelsBy : uint8_t {
    WholeCopy, ///< all is copied before the filters run, or all still blocks if there is a list
    CopyBack,  ///< what the filters wrote is copied over the picture
    InPlace,   ///< nothing is copied: the filters read a copy that is there anyway
};

/// Chooses the cheaper way for a picture with this share of moving blocks, with hysteresis, so that
/// a share near the limit does not recreate images in every frame.
[[nodiscard]] StaticPixelsBy chooseStaticPixels(double movingShare, StaticPixelsBy last);

class StaticPixels {
  public:
    explicit StaticPixels(gpu::Device& device);

    /// Returns the filters' target; `color` itself for InPlace.
    /// \param wholeTarget target of WholeCopy; invalid: a new image
    graph::ImageHandle begin(
        graph::Graph& graph,
        graph::ImageHandle color,
        graph::ImageHandle wholeTarget,
        StaticPixelsBy by
    ) const;

    /// The same, where WholeCopy copies still blocks alone if they are in a list.
    /// \param sorted of BlockSorter
    graph::ImageHandle begin(
        graph::Graph& graph,
        graph::ImageHandle color,
        graph::ImageHandle wholeTarget,
        StaticPixelsBy by,
        const BlockLists& sorted,
        const PassParams& params
    ) const;

    /// The whole picture.
    /// \param hasCandidates whether there were some, else all that moves is in the lists
    graph::ImageHandle
    end(graph::Graph& graph,
        graph::ImageHandle color,
        graph::ImageHandle filtered,
        const SortedBlocks& blocks,
        bool hasCandidates,
        const PassParams& params,
        StaticPixelsBy by) const;

  private:
    bool mListsStill;
    BlockFilter mStill;
    BlockFilter mUniform;
    BlockFilter mMixed;
    BlockFilter mCandidates;
};

} // namespace shutter::motion_blur
