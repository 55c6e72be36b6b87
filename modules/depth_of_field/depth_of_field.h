// SPDX-License-Identifier: MIT
// Depth of field from one picture and its depth, by filters of other engines, one with rays past
// what is near, for comparison with the lens of `resolved`. README.md describes how they follow
// their publications.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "engine/render/effect.h"
#include "modules/depth_of_field/filters.h"
#include "modules/depth_of_field/lens_rays.h"
#include "shaders/depth_of_field/depth_of_field_shared.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>

namespace shutter::depth_of_field {

inline constexpr uint32_t kDefaultTaps = 64;
inline constexpr uint32_t kMaxTaps = 1024;
inline constexpr uint32_t kDefaultRays = 4;
inline constexpr uint32_t kMaxRays = 64;

struct DepthOfFieldSettings {
    const Filter* filter = nullptr; ///< null: there is no depth of field
    uint32_t taps = kDefaultTaps;   ///< of each gather, [1, kMaxTaps]
    uint32_t rays = kDefaultRays;   ///< of each masked pixel, [1, kMaxRays]: Filter::tracesRays
};

/// Side of a tile in pixels, for a picture of that height: circles of confusion reach as far in
/// each.
[[nodiscard]] uint32_t computeTileSize(uint32_t height);

/// Filters the linear picture by the camera's lens at the raster instant; without a lens the
/// picture does not change. Circles of confusion are discs regardless of the lens's blades and
/// squeeze, and at most shader::kReachTiles tiles in radius. Writes RGBA16F.
class DepthOfField : public render::Effect {
  public:
    /// \param sceneLayout of the scene's textures, for filters that trace rays
    explicit DepthOfField(gpu::Device& device, VkDescriptorSetLayout sceneLayout = VK_NULL_HANDLE);

    /// For the frames to come. \param settings valid
    void configure(const DepthOfFieldSettings& settings);

    [[nodiscard]] std::string name() const override { return "depth of field"; }

    [[nodiscard]] render::PassOwner owner() const override { return render::PassOwner::Blur; }

    [[nodiscard]] render::Needs decide(const render::DecideContext& context) const override;
    void extract(render::ExtractContext& context) override;
    void declare(render::PictureContext& context) override;
    void finish(render::FinishedFrame& frame) override;

  private:
    [[nodiscard]] graph::ImageHandle addTiles(
        graph::Graph& graph, graph::ImageHandle motionDepth, const shader::LensFilterParams& params
    ) const;
    [[nodiscard]] graph::ImageHandle addReach(
        graph::Graph& graph, graph::ImageHandle tiles, const shader::LensFilterParams& params
    ) const;
    [[nodiscard]] graph::ImageHandle addFilter(
        const render::PictureContext& context,
        graph::ImageHandle reach,
        const shader::LensFilterParams& params
    );
    [[nodiscard]] LensRaysOutputs addRays(
        const render::PictureContext& context,
        graph::ImageHandle reach,
        const shader::LensFilterParams& params
    );
    /// Made when a frame first needs it.
    [[nodiscard]] const gpu::LazyPipeline& findFilterPipeline();

    gpu::Device& mDevice;
    VkDescriptorSetLayout mSceneLayout;
    DepthOfFieldSettings mSettings;
    double mConfusionPx = 0.0;  ///< of the frame that is extracted: LensFilterParams's
    double mInverseFocus = 0.0; ///< likewise, 1/m
    uint32_t mTurn = 0;         ///< likewise: ViewRequest::lensTurn
    gpu::LazyPipeline mTiles;
    gpu::LazyPipeline mReach;
    std::map<const Filter*, gpu::LazyPipeline> mFilters;
    std::optional<LensRays> mRays;                          ///< made when a frame first needs them
    std::array<bool, gpu::kMaxFramesInFlight> mHasTraced{}; ///< the slot's last frame
};

} // namespace shutter::depth_of_field
