// SPDX-License-Identifier: MIT
// A second raster of the world, at another time than the frame's: at the other end of the exposure
// or at the previous frame. Effects find surfaces in it that the frame's own raster lacks.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/frame_extractor.h"
#include "engine/gpu_scene/deformation_pass.h"
#include "engine/graph/graph.h"
#include "engine/render/contexts.h"
#include "engine/render/frame_tables.h"
#include "engine/render/gbuffer.h"
#include "engine/render/shading_feature.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::render {

/// The view of the end of the exposure that is farther from the raster instant.
[[nodiscard]] extract::ViewRequest makeViewOfOtherEnd(const extract::ViewRequest& view);

/// One for each frame in flight: the GPU must have finished the frame that it was last declared
/// for.
class OtherRaster {
  public:
    explicit OtherRaster(gpu::Device& device) : mTables(device), mDeformation(device) {}

    /// What the frame's own raster has too.
    struct Shared {
        std::span<ShadingFeature* const> shading;
        std::span<const ecs::Entity> taken; ///< whose blended surfaces are left out
        RasterKind kind = RasterKind::Second;
        uint32_t slot = 0;
    };

    /// \param view at the raster's time
    /// Error: as FrameExtractor::update and ShadingFeature::extract.
    [[nodiscard]] core::Status extract(
        const scene::World& world,
        const extract::SceneLayout& layout,
        const extract::ViewRequest& view,
        const Shared& shared
    );

    /// Returns the extracted raster.
    [[nodiscard]] ExtractedRaster extracted() const { return {mFrame, &mView}; }

    /// Declares the passes of the extracted raster, which must live until they have been recorded.
    /// \param name of the pass that draws it
    /// \param keepsEdges GBuffer::edgeSurface is read
    /// \param confusion GBufferPass::Source::confusion
    [[nodiscard]] OtherRasterView declare(
        graph::Graph& graph,
        const char* name,
        const gpu_scene::GpuScene& scene,
        GBufferPass& pass,
        bool keepsEdges,
        const math::vec2& confusion
    );

  private:
    extract::FrameExtractor mExtractor;
    FrameTables mTables;
    gpu_scene::DeformationPass mDeformation;
    RasterShading mShading;
    RasterKind mKind = RasterKind::Second;
    uint32_t mSlot = 0;
    extract::ViewRequest mView;
    const extract::ExtractedFrame* mFrame = nullptr;
    std::vector<uint32_t> mTaken; ///< rows of mFrame
};

} // namespace shutter::render
