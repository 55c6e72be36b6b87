// SPDX-License-Identifier: MIT
// Truth by distributed ray tracing (Cook, Porter and Carpenter 1984): each ray has its own time,
// stratified over the exposure; their mean is the picture. Progressive, and it knows its error.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/render/effect.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shutter::truth {

using extract::PixelModel;

struct TruthSettings {
    PixelModel pixel = PixelModel::Centre;
    uint32_t seed = 0; ///< another seed gives other times and places

    bool operator==(const TruthSettings&) const = default;
};

/// Texture level bias that matches the resolution of `rays` per pixel: 0 for the centre.
[[nodiscard]] float computeLodBias(PixelModel pixel, uint32_t rays);

/// Rays per pixel of each batch, in order: their sum is `rays`, and a batch ends at each of `stops`
/// below it (above 0). Batches are short enough not to trigger a driver's watchdog, except that a
/// batch has at least one ray per pixel.
/// \param pixels of the picture, above 0
[[nodiscard]] std::vector<uint32_t>
planBatches(uint64_t pixels, uint32_t rays, std::span<const uint32_t> stops);

/// Adds a batch of rays to a sum each frame; the context's colour becomes the mean of all so far.
/// Call setBatch() before each frame. Reads nothing of the G-buffer.
class Truth : public render::Effect {
  public:
    Truth(gpu::Device& device, const gpu_scene::GpuScene& scene, const TruthSettings& settings);

    /// \param first rays per pixel of earlier batches; 0 restarts
    /// \param count rays per pixel of this batch; 0, after the first, shows the mean again
    void setBatch(uint32_t first, uint32_t count);

    /// In the frame collected last: standard error of the mean in linear light, root mean square
    /// over pixels and channels. Nothing below two rays per pixel: one ray gives no error estimate.
    [[nodiscard]] std::optional<double> standardError() const { return mStandardError; }

    [[nodiscard]] std::string name() const override { return "truth"; }

    [[nodiscard]] render::PassOwner owner() const override { return render::PassOwner::Blur; }

    [[nodiscard]] render::Needs decide(const render::DecideContext& context) const override;

    /// Publishes "error": the standard error per pixel and channel.
    void declare(render::PictureContext& context) override;
    /// One frame at a time: the next may be declared once this was called.
    void finish(render::FinishedFrame& frame) override;

  private:
    struct Images {
        graph::ImageHandle sumA;
        graph::ImageHandle sumB;
    };

    Images importSums(render::PictureContext& context);

    gpu::Device& mDevice;
    TruthSettings mSettings;
    gpu::Pipeline mPipeline;
    gpu::Image mSumA;    ///< RGBA32F, in GENERAL layout between frames
    gpu::Image mSumB;    ///< the same
    gpu::Buffer mGroups; ///< squared error and rays of each group of the last frame
    uint32_t mGroupCount = 0;
    uint64_t mPixels = 0;
    uint32_t mFirst = 0;
    uint32_t mCount = 1;
    std::optional<double> mStandardError;
};

} // namespace shutter::truth
