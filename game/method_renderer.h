// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/render/renderer.h"
#include "game/render_options.h"
#include "game/shot.h"
#include "modules/accumulate/accumulate.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "modules/tonemap/tonemap.h"

#include <functional>
#include <memory>

namespace shutter::game {

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
    /// \param onStep called after each frame drawn (progress)
    [[nodiscard]] core::Result<render::FrameResult>
    renderPicture(double seconds, const std::function<void()>& onStep);

    /// Frames drawn for one picture.
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

    const Shot& mShot;
    const RenderOptions& mOptions;
    render::Renderer& mRenderer;
    std::unique_ptr<motion_blur::MotionBlurPlugin> mMotionBlur;
    std::unique_ptr<accumulate::Accumulate> mAccumulate;
    tonemap::Tonemap mTonemap;
};

} // namespace shutter::game
