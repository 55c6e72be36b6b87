// SPDX-License-Identifier: MIT
// The motion blur's place in this engine's frame.
#pragma once

#include "engine/render/post_effect.h"
#include "engine/render/renderer.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/motion_blur.h"

#include <cstddef>
#include <span>
#include <string>

namespace shutter::motion_blur {

class MotionBlurPlugin : public render::PostEffect {
  public:
    /// Settings and budget must be valid.
    MotionBlurPlugin(
        gpu::Device& device,
        const render::GpuScene& scene,
        const MotionBlurSettings& settings,
        const BlurBudget& budget = {}
    );

    [[nodiscard]] std::string name() const override { return "motion blur"; }

    /// Skipped when nothing moves, the exposure is 0, or the budget is too small for any blur.
    [[nodiscard]] render::Decision ask(const render::ViewFacts& facts) const override;

    /// The hybrid method's.
    [[nodiscard]] render::Decision askRays(const render::ViewFacts& facts) const override;
    /// The denoised method's.
    [[nodiscard]] render::Decision askMovingRays(const render::ViewFacts& facts) const override;

    void declare(render::PostContext& context) override;
    void observe(std::span<const gpu::PassTime> passes) override;
    void collect(render::Counters& counters) override;
    /// The rung of the budget's ladder, and what the effect took.
    void measure(render::Measures& measures) override;

  private:
    [[nodiscard]] const MotionBlurSettings& settings() const { return mBudget.current().settings; }

    BudgetController mBudget;
    Method mDrawnMethod = Method::Hybrid; ///< of the frame declared last
    size_t mDrawnRung = 0;                ///< of the frame declared last
    double mMilliseconds = 0.0;           ///< that it took
    MotionBlur mEffect;
};

} // namespace shutter::motion_blur
