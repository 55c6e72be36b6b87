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
/// Most frames that a picture is the mean of: with two rounds of the places, those of the newest
/// frames weigh little more than the others. Half floats would not keep smaller shares.
inline constexpr uint32_t kMostFrames = 2 * kPlaceCount;
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
/// Temporal Supersampling"): history by the surface's own motion, Catmull-Rom between its texels,
/// clipped to the variance of the neighbourhood in YCoCg. History counts where the last frame's
/// depth says that it is of the same surface, or of one across an edge that moves along; elsewhere
/// the pixel is filtered from the samples around it. A pixel is the plain mean of the frames behind
/// it up to kMostFrames, then each new one has an equal share. Runs on the linear picture before
/// the motion blur. The view must be one of makeJittered(); its colour has no jitter afterwards
/// (ExtractContext::colorJitterPx), the other images of the raster keep theirs. Keeps 24 bytes a
/// pixel: colour and depth, of this frame and the last one.
class Taa : public render::PostEffect {
  public:
    explicit Taa(gpu::Device& device);

    /// For the frames to come. Disabled, it keeps no picture.
    void setEnabled(bool enabled) { mEnabled = enabled; }

    [[nodiscard]] std::string name() const override { return "taa"; }

    [[nodiscard]] core::Decision ask(const render::ViewFacts& facts) const override;
    void extract(render::ExtractContext& context) override;
    void declare(render::PostContext& context) override;
    void finish(render::FinishedFrame& frame) override;

  private:
    gpu::Device& mDevice;
    gpu::LazyPipeline mPipeline;
    LastPicture mLast;
    bool mEnabled = true;
};

} // namespace shutter::taa
