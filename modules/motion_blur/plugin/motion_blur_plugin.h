// SPDX-License-Identifier: MIT
// The motion blur's place in this engine's frame.
#pragma once

#include "engine/render/post_effect.h"
#include "engine/render/renderer.h"
#include "modules/motion_blur/motion_blur.h"

#include <string>

namespace shutter::motion_blur {

class MotionBlurPlugin : public render::PostEffect {
  public:
    /// Settings must be valid.
    MotionBlurPlugin(
        gpu::Device& device, const render::GpuScene& scene, const MotionBlurSettings& settings
    );

    [[nodiscard]] std::string name() const override { return "motion blur"; }

    /// Skipped when nothing moves or the exposure is 0.
    [[nodiscard]] render::Decision ask(const render::ViewFacts& facts) const override;

    /// The hybrid method's.
    [[nodiscard]] render::Decision askRays(const render::ViewFacts& facts) const override;
    /// The denoised method's.
    [[nodiscard]] render::Decision askMovingRays(const render::ViewFacts& facts) const override;

    void declare(render::PostContext& context) override;
    void collect(render::Counters& counters) override;

  private:
    MotionBlurSettings mSettings;
    MotionBlur mEffect;
};

} // namespace shutter::motion_blur
