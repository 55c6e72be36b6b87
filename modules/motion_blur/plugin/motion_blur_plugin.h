// SPDX-License-Identifier: MIT
// The motion blur's place in this engine's frame.
#pragma once

#include "engine/render/post_effect.h"
#include "engine/render/renderer.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/motion_blur.h"
#include "modules/motion_blur/plugin/instant_motion_buffers.h"

#include <array>
#include <cstddef>
#include <string>

namespace shutter::motion_blur {

class MotionBlurPlugin : public render::PostEffect {
  public:
    /// Settings and budget must be valid.
    MotionBlurPlugin(
        gpu::Device& device,
        const gpu_scene::GpuScene& scene,
        const MotionBlurSettings& settings,
        const BlurBudget& budget = {}
    );

    /// For the frames to come; both must be valid. The budget starts anew where either changed.
    void configure(const MotionBlurSettings& settings, const BlurBudget& budget);

    [[nodiscard]] std::string name() const override { return "motion blur"; }

    /// Skipped when nothing moves or the exposure is 0; no budget skips it.
    [[nodiscard]] core::Decision ask(const render::ViewFacts& facts) const override;

    /// For methods of RayNeed::Any.
    [[nodiscard]] core::Decision askRays(const render::ViewFacts& facts) const override;
    /// For methods of RayNeed::Query, in frames that are shown.
    [[nodiscard]] core::Decision askTimedRays(const render::ViewFacts& facts) const override;

    /// With MotionBlurSettings::secondRaster, for methods that read it, in frames that are
    /// shown.
    [[nodiscard]] core::Decision askSecondRaster(const render::ViewFacts& facts) const override;

    void declare(render::PostContext& context) override;
    /// Measures what the effect took and, under a budget, its level.
    void finish(render::FinishedFrame& frame) override;

  private:
    [[nodiscard]] const MotionBlurSettings& settings() const { return mBudget.current().settings; }

    /// Whether the frame is drawn for what the next one looks up, and the method keeps something.
    [[nodiscard]] bool onlyKeeps(const render::ViewFacts& facts) const;

    MotionBlurSettings mWanted;
    BudgetController mBudget;
    std::array<size_t, gpu::kMaxFramesInFlight> mDrawnLevels{}; ///< of the budget, by slot
    InstantMotionBuffers mInstantMotions;
    MotionBlur mEffect;
};

} // namespace shutter::motion_blur
