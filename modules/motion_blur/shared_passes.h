// SPDX-License-Identifier: MIT
// Passes that methods have in common, and the frame around a method whose filters go over blocks.
#pragma once

#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/cost_view.h"
#include "modules/motion_blur/passes/static_pixels.h"
#include "modules/motion_blur/passes/tile_motion.h"

namespace shutter::motion_blur {

class SharedPasses {
  public:
    explicit SharedPasses(gpu::Device& device)
        : tileMotion(device), sorter(device), stillPixels(device), costView(device) {}

    /// To be called once per frame, before the passes are declared.
    void chooseStillPixelsBy(const MotionBlurInputs& inputs);

    TileMotion tileMotion;
    BlockSorter sorter;
    StaticPixels stillPixels;
    CostView costView;
    StaticPixelsBy stillPixelsBy = StaticPixelsBy::WholeCopy; ///< of this frame
};

/// Inputs of a filter over blocks of mixed motion.
struct BlockInputs {
    const MotionBlurInputs& frame;
    const TileMotionOutputs& tiles;
    const SortedBlocks& blocks;
};

/// A method whose filters write the blocks that move: tiles and lists are there before it, still
/// pixels come from the sharp picture.
class BlockMethod : public MethodPasses {
  public:
    [[nodiscard]] MotionBlurOutputs
    add(graph::Graph& graph,
        const MotionBlurInputs& inputs,
        const MotionBlurSettings& settings,
        const PassParams& params,
        SharedPasses& shared) override;

  protected:
    /// Declares the filters.
    /// \param views takes those of the method, beyond "tiles" and "cost"
    /// \return target with all moving blocks written
    [[nodiscard]] virtual graph::ImageHandle filter(
        graph::Graph& graph,
        const BlockInputs& inputs,
        graph::ImageHandle target,
        const PassParams& params,
        std::vector<View>& views
    ) const = 0;
};

enum class DominantMotion : uint8_t { Unused, Read };

/// A method of one filter over all blocks that move. Its shader samples colour, motion and depth
/// and, where it reads that, the dominant motion.
[[nodiscard]] std::unique_ptr<MethodPasses> makeOnePassMethod(
    gpu::Device& device, const char* pass, std::span<const uint32_t> spirv, DominantMotion dominant
);

} // namespace shutter::motion_blur
