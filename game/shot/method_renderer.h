// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/render/renderer.h"
#include "game/options/render_options.h"
#include "game/shot/shot.h"
#include "modules/accumulate/accumulate.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "modules/tonemap/tonemap.h"
#include "modules/truth/truth.h"

#include <functional>
#include <memory>
#include <vector>

namespace shutter::game {

/// Pictures on the way of a progressive method.
struct Checkpoints {
    std::vector<uint32_t> rays; ///< a pixel, above 0, any order; those above --samples never come
    /// The picture so far, what was asked for of it (no intermediates), with the times summed so
    /// far. Called for the last picture too where its rays are among `rays`.
    std::function<void(uint32_t rays, const render::FrameResult& picture)> onPicture;
};

/// Draws a shot with one method: the effects the method is made of, in their order.
class MethodRenderer {
  public:
    /// Error: the method needs rays and the device has none.
    /// \param renderer of the shot's assets; outlives this, and several may share it
    [[nodiscard]] static core::Result<std::unique_ptr<MethodRenderer>> create(
        gpu::Device& device,
        render::Renderer& renderer,
        const Shot& shot,
        const RenderOptions& options
    );

    /// One finished picture at `seconds`. Times of a method that draws many frames are summed.
    /// \param onStep called stepsPerPicture() times (progress)
    /// \param checkpoints MethodFamily::Truth only; the others draw none
    [[nodiscard]] core::Result<render::FrameResult> renderPicture(
        double seconds, const std::function<void()>& onStep, const Checkpoints& checkpoints = {}
    );

    /// Steps of the work for one picture: frames, or rays a pixel.
    [[nodiscard]] uint32_t stepsPerPicture() const;

  private:
    MethodRenderer(
        gpu::Device& device,
        render::Renderer& renderer,
        const Shot& shot,
        const RenderOptions& options
    );
    core::Result<render::FrameResult>
    renderAccumulated(const render::FrameRequest& request, const std::function<void()>& onStep);
    core::Result<render::FrameResult> renderTruth(
        const render::FrameRequest& request,
        const std::function<void()>& onStep,
        const Checkpoints& checkpoints
    );
    [[nodiscard]] bool isGoodEnough(uint32_t rays) const;

    const Shot& mShot;
    const RenderOptions& mOptions;
    render::Renderer& mRenderer;
    std::unique_ptr<motion_blur::MotionBlurPlugin> mMotionBlur;
    std::unique_ptr<accumulate::Accumulate> mAccumulate;
    std::unique_ptr<truth::Truth> mTruth;
    tonemap::Tonemap mTonemap;
};

} // namespace shutter::game
