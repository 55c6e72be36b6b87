// SPDX-License-Identifier: MIT
// Brute-force truth: M sharp frames at M instants of the exposure, averaged (Korein and Badler
// 1983; Haeberli and Akeley 1990). Slow and exact; the reference of the other methods.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/render/effect.h"

#include <cstdint>
#include <optional>
#include <string>

namespace shutter::accumulate {

using extract::PixelModel;

/// The i-th of `count` sharp views: time stratified over the exposure's light (the middle of each
/// stratum; with a box response, of each stretch of time), place in the pixel by a (2, 3)-Halton
/// sequence, so that the two together are a Hammersley set. Box also sharpens textures to what
/// `count` samples can resolve. Where the view uses the lens, places in the lens and in the pixel
/// are those of Sobol's sequence in four dimensions: with 32 samples and more, no two depend on
/// each other, nor on the time. \param seed another seed gives another set of places
[[nodiscard]] extract::ViewRequest makeInstant(
    const extract::ViewRequest& view,
    uint32_t index,
    uint32_t count,
    PixelModel pixel,
    uint32_t seed
);

/// The i-th of `count` views that differ in their place in the pixel, which makeInstant() takes for
/// PixelModel::Box, and in nothing else of time.
[[nodiscard]] extract::ViewRequest
makeSubpixel(const extract::ViewRequest& view, uint32_t index, uint32_t count, uint32_t seed);

/// A frame's part in the mean of several.
struct SummedFrame {
    bool isFirst = true; ///< the sum starts with it
    bool isLast = true;  ///< the context's colour becomes the mean
    double weight = 1.0; ///< above 0
    double total = 1.0;  ///< of all frames' weights, where `isLast`
};

/// Adds each frame's colour to a sum. Call setFrame() or setInstant() before each frame.
class Accumulate : public render::Effect {
  public:
    explicit Accumulate(gpu::Device& device);

    void setFrame(const SummedFrame& frame) { mFrame = frame; }

    /// Chooses one of `count` frames that count alike. \param index below `count`
    void setInstant(uint32_t index, uint32_t count);

    [[nodiscard]] std::string name() const override { return "accumulate"; }

    [[nodiscard]] render::PassOwner owner() const override { return render::PassOwner::Blur; }

    [[nodiscard]] render::Needs decide(const render::DecideContext& context) const override;
    void declare(render::PictureContext& context) override;

  private:
    gpu::Device& mDevice;
    gpu::Pipeline mPipeline;
    gpu::Image mSum; ///< RGBA32F, in GENERAL layout between frames
    SummedFrame mFrame;
};

} // namespace shutter::accumulate
