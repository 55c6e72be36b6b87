// SPDX-License-Identifier: MIT
// The motion blur's place in this engine's frame.
#pragma once

#include "engine/core/idle_counter.h"
#include "engine/render/effect.h"
#include "engine/render/renderer.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/motion_blur.h"
#include "modules/motion_blur/passes/composite.h"
#include "modules/motion_blur/plugin/instant_motion_buffers.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace shutter::motion_blur {

/// Behaviour of a frame whose method's pipelines are still being made ahead.
enum class UntilReady : uint8_t {
    Wait,    ///< it waits for them: pictures do not depend on time
    StandIn, ///< Method::standIn draws it
};

/// Subject of the explanation of frames that another method draws in place of `wanted`: a stand-in,
/// or the budget's. Its reason is that method's name.
[[nodiscard]] std::string nameReplacement(const Method& wanted);

class MotionBlurPlugin : public render::Effect {
  public:
    /// Settings and budget must be valid.
    MotionBlurPlugin(
        gpu::Device& device,
        const gpu_scene::GpuScene& scene,
        const MotionBlurSettings& settings,
        const BlurBudget& budget = {}
    );

    /// For the frames to come; settings and budget must be valid. The budget restarts if the
    /// settings changed.
    void configure(
        const MotionBlurSettings& settings,
        const BlurBudget& budget,
        UntilReady untilReady = UntilReady::Wait
    );

    [[nodiscard]] std::string name() const override { return "motion blur"; }

    [[nodiscard]] render::PassOwner owner() const override { return render::PassOwner::Blur; }

    /// Skipped when nothing moves or the exposure is 0; no budget skips it. By Method: rays for
    /// RayNeed::Any, timed rays for RayNeed::Query; edges and history for lookups; blended surfaces
    /// leave the raster where that is blurred. The second raster is MotionBlurSettings' own wish.
    /// The last raster is drawn where the previous frame left none: nothing moved in it, another
    /// method drew it, or it had another size. Frames that are not shown need no second or last
    /// raster and no timed rays.
    [[nodiscard]] render::Needs decide(const render::DecideContext& context) const override;
    void extract(render::ExtractContext& context) override;

    void declare(render::PictureContext& context) override;
    /// Measures the effect's time and, under a budget, its level.
    void finish(render::FinishedFrame& frame) override;

  private:
    /// State of a slot's frame.
    struct Drawn {
        size_t level = 0;               ///< of the budget, or kNoLevel
        bool keepsOnly = false;         ///< onlyKeeps()
        bool standsIn = false;          ///< by Method::standIn
        bool hasHistory = false;        ///< readsHistory()
        const Method* wanted = nullptr; ///< of the settings
        const Method* method = nullptr; ///< that draws it
    };

    /// The next frame is drawn with them.
    [[nodiscard]] const MotionBlurSettings& settings() const {
        return mStandIn ? *mStandIn : mBudget.current().settings;
    }

    /// Decides whether another method draws the next frame in place of the budget's.
    void chooseStandIn();

    [[nodiscard]] core::Decision decideRun(const render::ViewFacts& facts) const;
    [[nodiscard]] core::Decision decideRays(const render::ViewFacts& facts) const;
    [[nodiscard]] core::Decision
    decideLastRaster(const render::DecideContext& context, const render::Needs& needs) const;

    /// Whether the next frame's method draws its samples from places of the lens.
    [[nodiscard]] bool usesLens(const render::ViewFacts& facts) const;

    /// Whether the next frame's method reads the raster of the previous one.
    [[nodiscard]] bool readsHistory() const;

    /// Whether the frame is drawn only as history for the next one, and the method stores history.
    [[nodiscard]] bool onlyKeeps(const render::ViewFacts& facts) const;

    MotionBlurSettings mWanted;
    BudgetController mBudget;
    UntilReady mUntilReady = UntilReady::Wait;
    std::optional<MotionBlurSettings> mStandIn; ///< of the next frame; nothing: the budget's
    std::array<Drawn, gpu::kMaxFramesInFlight> mDrawn{}; ///< by slot
    InstantMotionBuffers mInstantMotions;
    Composite mComposite;
    core::IdleCounter mHistoryIdle;
    MotionBlur mEffect;
};

} // namespace shutter::motion_blur
