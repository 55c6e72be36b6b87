// SPDX-License-Identifier: MIT
// Light that the lens scatters: bright things glow, and their streaks read as light.
#pragma once

#include "engine/core/result.h"
#include "engine/core/setting_row.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "engine/render/effect.h"

#include <cstdint>

namespace shutter::bloom {

inline constexpr float kMaxThreshold = 65000.0f; ///< shader::kMaxColor

struct BloomSettings {
    float share = 0.0f; ///< of a highlight's light that is scattered, [0, 1]; 0: there is no bloom
    /// Light of a pixel's brightest channel above which it is a highlight, in the linear picture's
    /// unit, 0 or more; 0: all light is scattered, as a real lens does.
    float threshold = 1.0f;
    /// How far below and above the threshold pixels are highlights in part, as a share of it, [0,
    /// 1].
    float knee = 0.5f;
};

/// Where the knee begins: a picture with no brighter channel has no highlight.
[[nodiscard]] float findKneeStart(const BloomSettings& settings);

/// Names, ranges and options of BloomSettings.
[[nodiscard]] core::SettingRows<BloomSettings> listBloomRows();

/// Images of the pyramid below a picture, each half as large as the one before; 0 for pictures that
/// are too small to have any. The smallest is a few pixels high, so that light spreads over the
/// same share of the picture at every resolution.
[[nodiscard]] uint32_t countLevels(uint32_t width, uint32_t height);

/// Pyramid of Jimenez 2014 ("Next Generation Post Processing in Call of Duty: Advanced Warfare"),
/// of the light above a threshold (shaders/bloom/bloom.glsl). Scattered light is subtracted at its
/// source: the picture's total light is preserved, and a picture without highlights does not
/// change. Runs on the linear picture, after the motion blur and before the tone map; writes
/// RGBA16F.
///
/// Where the last picture is known (ViewFacts::lastBrightest) and had no highlight, it does not
/// run: a highlight that appears glows as many pictures later as it takes to know of it.
class Bloom : public render::Effect {
  public:
    /// \param settings valid
    Bloom(gpu::Device& device, const BloomSettings& settings);

    /// For the frames to come.
    void configure(const BloomSettings& settings);

    [[nodiscard]] std::string name() const override { return "bloom"; }

    [[nodiscard]] render::Needs decide(const render::DecideContext& context) const override;
    void declare(render::PictureContext& context) override;

  private:
    [[nodiscard]] core::Decision decideRun(const render::ViewFacts& facts) const;
    [[nodiscard]] graph::ImageHandle
    addDown(graph::Graph& graph, graph::ImageHandle source, VkExtent2D size, float threshold) const;
    /// \param share of `coarse` in the result, which has the size of `fine`
    [[nodiscard]] graph::ImageHandle addUp(
        graph::Graph& graph,
        graph::ImageHandle fine,
        graph::ImageHandle coarse,
        float share,
        float threshold
    ) const;

    gpu::Device& mDevice;
    BloomSettings mSettings;
    gpu::LazyPipeline mDown;
    gpu::LazyPipeline mUp;
};

} // namespace shutter::bloom
