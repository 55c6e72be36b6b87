// SPDX-License-Identifier: MIT
// Temporal anti-aliasing: each frame samples another place in the pixel, and the pictures before
// carry the other samples, found again by motion.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/pipeline.h"
#include "engine/math/math.h"
#include "engine/render/post_effect.h"
#include "modules/taa/last_picture.h"

#include <cstdint>
#include <string>

namespace shutter::taa {

/// Places in the pixel, one frame behind the other; then they begin anew. A picture holds about as
/// many samples a pixel where it can.
inline constexpr uint32_t kPlaceCount = 16;
/// Frames before a picture that settle what it shows, where none was drawn.
inline constexpr uint32_t kSettlingFrames = kPlaceCount - 1;

/// Place of a frame's samples: by the sequence of Halton with bases 2 and 3, from the pixel's
/// centre, pixels, right and down, within (-0.5, 0.5).
[[nodiscard]] math::dvec2 computeJitterPx(int64_t frameNumber);

/// The view that a frame of an anti-aliased sequence draws: jittered, with textures as sharp as its
/// samples together resolve. \param frameNumber any; frames that follow one another have numbers
/// that do
[[nodiscard]] extract::ViewRequest
makeJittered(const extract::ViewRequest& view, int64_t frameNumber);

/// After Karis 2014 ("High Quality Temporal Supersampling") and Salvi 2016 ("An Excursion in
/// Temporal Supersampling"): history by the motion of the nearest surface, Catmull-Rom between its
/// texels, clipped to the variance of the neighbourhood in YCoCg. A pixel with as many frames
/// behind it as kPlaceCount is a mean of that many; before, the plain mean of all. Runs on the
/// linear picture before the motion blur. The view must be one of makeJittered(); its colour has
/// no jitter afterwards (PostContext::colorJitterPx), the other images of the raster keep theirs.
class Taa : public render::PostEffect {
  public:
    explicit Taa(gpu::Device& device);

    /// For the frames to come. Disabled, it keeps no picture.
    void setEnabled(bool enabled) { mEnabled = enabled; }

    [[nodiscard]] std::string name() const override { return "taa"; }

    /// The picture is what it works on, with or without blur.
    [[nodiscard]] render::PassOwner owner() const override { return render::PassOwner::Scene; }

    [[nodiscard]] core::Decision ask(const render::ViewFacts& facts) const override;
    void declare(render::PostContext& context) override;
    void finish(render::FinishedFrame& frame) override;

  private:
    gpu::Device& mDevice;
    gpu::LazyPipeline mPipeline;
    LastPicture mLast;
    bool mEnabled = true;
};

} // namespace shutter::taa
