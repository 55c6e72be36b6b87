// SPDX-License-Identifier: MIT
// Motion of a view's points over its exposure, measured on raster images that nobody sees.
#pragma once

#include "engine/core/result.h"
#include "engine/render/longest_motion.h"
#include "engine/render/overlay.h"
#include "engine/render/renderer.h"

#include <optional>
#include <span>
#include <vector>

namespace shutter::render {

/// Longest motion in a picture during its exposure.
struct LongestPath {
    /// Of a visible point or of something unseen that matters (ViewRequest::unseenMatters), pixels.
    /// 0: nothing moves.
    double px = 0.0;
    bool movesLight = false;  ///< one that lights the picture does
    bool hasFleeting = false; ///< something appears, disappears or changes its colour
};

/// Draws with a renderer that has no unfinished frame (CHECKed) and that outlives this.
class MotionMeasures {
  public:
    MotionMeasures(gpu::Device& device, Renderer& renderer)
        : mDevice(device), mRenderer(renderer) {}

    /// Measures the shares of motion that remain under the view's cap
    /// (CameraShutter::maxBlurPercent): pass them to ExposureInterval::cap of everything drawn of
    /// this exposure. Draws the raster image up to four times; draws nothing without a cap.
    [[nodiscard]] core::Result<scene::MotionCap>
    measureCap(const scene::World& world, const extract::ViewRequest& view);

    /// Measures the motion of the picture's points in the exposure. Measured on raster images, one
    /// for each part of the exposure (extract::planMotionParts); nothing is drawn where nothing
    /// moves.
    [[nodiscard]] core::Result<LongestPath> measureLongestPath(
        const scene::World& world,
        const extract::ViewRequest& view,
        std::span<const Overlay* const> overlays
    );

  private:
    /// \return pixels from open to close, one number per row, then the sky's
    [[nodiscard]] core::Result<std::vector<float>>
    drawMotion(const scene::World& world, const extract::ViewRequest& view);

    gpu::Device& mDevice;
    Renderer& mRenderer;
    std::optional<LongestMotion> mLongestMotion; ///< made by the first measurement
};

} // namespace shutter::render
