// SPDX-License-Identifier: MIT
// The floor under gather's time in a frame of this engine: the same passes before it, then the same
// fetches, averaged.
#pragma once

#include "engine/render/post_effect.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/tap_floor.h"
#include "modules/motion_blur/passes/tile_motion.h"
#include "modules/motion_blur/settings.h"

namespace shutter::demand {

class FloorEffect : public render::PostEffect {
  public:
    FloorEffect(gpu::Device& device, const motion_blur::MotionBlurSettings& settings);

    [[nodiscard]] std::string name() const override { return "gather floor"; }

    /// Skipped as motion blur is.
    [[nodiscard]] core::Decision ask(const render::ViewFacts& facts) const override;
    void declare(render::PostContext& context) override;

  private:
    motion_blur::MotionBlurSettings mSettings;
    motion_blur::TileMotion mTileMotion;
    motion_blur::BlockSorter mSorter;
    motion_blur::TapFloor mFloor;
};

} // namespace shutter::demand
