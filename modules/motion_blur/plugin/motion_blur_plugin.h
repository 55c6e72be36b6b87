// SPDX-License-Identifier: MIT
// The motion blur's place in this engine's frame.
#pragma once

#include "engine/render/post_effect.h"
#include "engine/render/renderer.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/motion_blur.h"
#include "modules/motion_blur/plugin/blended_surfaces.h"
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

class MotionBlurPlugin : public render::PostEffect {
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

    /// Skipped when nothing moves or the exposure is 0; no budget skips it.
    [[nodiscard]] core::Decision decide(const render::ViewFacts& facts) const override;

    /// For methods of RayNeed::Any.
    [[nodiscard]] core::Decision decideRays(const render::ViewFacts& facts) const override;
    /// For methods of RayNeed::Query, in frames that are shown.
    [[nodiscard]] core::Decision askTimedRays(const render::ViewFacts& facts) const override;

    /// True for methods with lookups.
    [[nodiscard]] bool readsEdges() const override;
    [[nodiscard]] bool readsNormals() const override;
    /// For methods that blur the raster.
    [[nodiscard]] core::Decision askLayer(const render::ViewFacts& facts) const override;
    /// Whether its samples have places of the lens.
    [[nodiscard]] bool seesThroughLens(const render::ViewFacts& facts) const override;

    /// With MotionBlurSettings::secondRaster, for methods that read it, in frames that are
    /// shown.
    [[nodiscard]] core::Decision askSecondRaster(const render::ViewFacts& facts) const override;

    /// With MotionBlurSettings::history, for methods that read it, in frames that are shown and
    /// follow one that left no raster: nothing moved in it, another method drew it, or it had
    /// another size.
    [[nodiscard]] core::Decision askLastRaster(const render::ExtractContext& context
    ) const override;
    /// Where there is an exposure, whether or not anything else moves in it.
    [[nodiscard]] core::Decision decideParticleDraw(const render::ViewFacts& facts) const override;
    void extract(render::ExtractContext& context) override;

    void declare(render::PostContext& context) override;
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
    BlendedSurfaces mBlended;
    render::IdleCounter mHistoryIdle;
    MotionBlur mEffect;
};

} // namespace shutter::motion_blur
