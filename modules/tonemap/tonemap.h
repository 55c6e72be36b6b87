// SPDX-License-Identifier: MIT
// Converts linear HDR to display values: gain, tone mapper, sRGB.
#pragma once

#include "engine/core/setting_row.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/image/image.h"
#include "engine/render/effect.h"

#include <array>
#include <cstdint>
#include <string>

namespace shutter::tonemap {

enum class Operator : uint8_t {
    None,    ///< values above 1 are cut off
    Neutral, ///< Khronos PBR Neutral
};

struct TonemapSettings {
    Operator op = Operator::Neutral;
    double exposureValue = 0.0; ///< stops: the picture is multiplied by 2^EV first, [-32, 32]
};

/// Names, ranges and options of TonemapSettings.
[[nodiscard]] core::SettingRows<TonemapSettings> listTonemapRows();

/// 2^EV, the factor before the operator.
[[nodiscard]] float computeGain(const TonemapSettings& settings);

/// Runs when a display-encoded picture is wanted; writes PictureContext::display (RGBA8). On
/// request (ViewFacts::brightestWanted) also measures render::kBrightest, since it reads each pixel
/// anyway.
class Tonemap : public render::Effect {
  public:
    Tonemap(gpu::Device& device, const TonemapSettings& settings);

    /// For the frames to come.
    void configure(const TonemapSettings& settings) { mSettings = settings; }

    [[nodiscard]] std::string name() const override { return "tone map"; }

    [[nodiscard]] render::PassOwner owner() const override { return render::PassOwner::Display; }

    [[nodiscard]] render::Needs decide(const render::DecideContext& context) const override;
    void declare(render::PictureContext& context) override;
    void finish(render::FinishedFrame& frame) override;

  private:
    /// Makes the buffer for a slot's group results. \return invalid: not requested
    [[nodiscard]] graph::BufferHandle prepareBrightest(render::PictureContext& context);

    /// Results of a frame's groups.
    struct Brightest {
        gpu::Buffer groups;      ///< float[]: of each group's pixels
        uint32_t groupCount = 0; ///< of the slot's frame; 0: not requested
    };

    gpu::Device& mDevice;
    TonemapSettings mSettings;
    gpu::LazyPipeline mPipeline;
    gpu::LazyPipeline mMeasuring;
    std::array<Brightest, gpu::kMaxFramesInFlight> mBrightest; ///< by slot
};

/// `linear` as a display takes it, by the very functions of the shader (gain, operator, sRGB), not
/// rounded to eight bits. One channel (grey) or three: CHECKed. Light below 0 counts as 0, infinite
/// light as white. A pixel with a NaN is NaN in every channel, so that a metric can count it.
[[nodiscard]] image::Image
computeDisplayImage(const image::Image& linear, const TonemapSettings& settings);

} // namespace shutter::tonemap
