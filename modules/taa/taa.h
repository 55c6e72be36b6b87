// SPDX-License-Identifier: MIT
// Temporal anti-aliasing: each frame samples another place in the pixel of static surfaces, and
// accumulates their mean.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/pipeline.h"
#include "engine/math/math.h"
#include "engine/render/effect.h"
#include "modules/taa/static_layer.h"

#include <cstdint>
#include <string>

namespace shutter::taa {

using shader::kPlaceCount;
/// Number of frames to draw before a picture without history, so that it settles.
inline constexpr uint32_t kSettlingFrames = kPlaceCount - 1;

/// Place of a frame's samples: by Sobol's sequence in two dimensions, whose first kPlaceCount
/// places lie evenly and around the centre (Sobol 1967); from the pixel's centre, pixels, right and
/// down, within (-0.5, 0.5).
[[nodiscard]] math::dvec2 computeJitterPx(int64_t frameNumber);

/// The view that a frame of an anti-aliased sequence draws: jittered, with textures as sharp as its
/// samples together resolve. \param frameNumber any; frames that follow one another have numbers
/// that do
[[nodiscard]] extract::ViewRequest
makeJittered(const extract::ViewRequest& view, int64_t frameNumber);

/// Where neither the camera nor the entity moves, a pixel is the mean of the first kPlaceCount
/// frames in which it was visible; then it does not change, even while something moves in front.
/// Sums do not depend on the frames' order, so a sequence that resumes has the same bits where
/// nothing has moved in front or changed since it settled. In frames in which static surfaces may
/// differ (another light; with a ShadingFeature or blended surfaces, an entity that appears,
/// disappears, starts or stops; an overlay, a blended mover, tiles of kSlotChanging) it is clipped
/// to the variance of the neighbourhood in YCoCg (Salvi 2016, "An Excursion in Temporal
/// Supersampling"), mixed as Karis 2014 ("High Quality Temporal Supersampling"). Movers have one
/// sample at the pixel's centre and no history: motion blur smooths it, and reprojected history is
/// farther from the mean over the pixel than none (docs/anti_aliasing.md). Where a lens spreads
/// something, nothing has: what is out of focus has several samples per pixel instead. Runs on the
/// linear picture before the motion blur. The view must be one of makeJittered(); afterwards its
/// colour has no jitter (ExtractContext::colorJitterPx), other images of the raster remain jittered
/// where the surface is static. Memory: 20 bytes per pixel: sum, count and row.
class Taa : public render::Effect {
  public:
    explicit Taa(gpu::Device& device);

    /// Applies to later frames. Disabled, it stores no history.
    void setEnabled(bool enabled) { mEnabled = enabled; }

    [[nodiscard]] std::string name() const override { return "taa"; }

    [[nodiscard]] render::Needs decide(const render::DecideContext& context) const override;
    void extract(render::ExtractContext& context) override;
    void declare(render::PictureContext& context) override;
    void finish(render::FinishedFrame& frame) override;

  private:
    gpu::Device& mDevice;
    gpu::LazyPipeline mPipeline;
    StaticLayer mStatic;
    bool mEnabled = true;
};

} // namespace shutter::taa
