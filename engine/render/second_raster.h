// SPDX-License-Identifier: MIT
// The world as it is at the other end of the exposure, drawn for effects that look up there what
// the frame's own raster does not hold.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/frame_extractor.h"
#include "engine/gpu_scene/deformation_pass.h"
#include "engine/graph/graph.h"
#include "engine/render/frame_tables.h"
#include "engine/render/gbuffer.h"
#include "engine/render/post_effect.h"

#include <memory>

namespace shutter::render {

class ShadowMaps;
struct ShadowPipelines;

/// Shutter time of the end of the exposure that is farther from the raster instant: 0 or 1.
[[nodiscard]] double findOtherEnd(double rasterTime);

/// One for each frame in flight: the GPU must be done with the frame that it was declared for last.
class SecondRaster {
  public:
    explicit SecondRaster(gpu::Device& device);
    ~SecondRaster();

    /// \param view the frame's own, which gets the other instant
    /// Error: as FrameExtractor::update.
    [[nodiscard]] core::Status extract(
        const scene::World& world, const extract::SceneLayout& layout, extract::ViewRequest view
    );

    /// Declares the passes of what was extracted, which must live until they have been recorded.
    /// \param shadows null: lights cast none
    [[nodiscard]] SecondRasterView declare(
        graph::Graph& graph,
        const gpu_scene::GpuScene& scene,
        const GBufferPass& pass,
        const ShadowPipelines* shadows
    );

  private:
    extract::FrameExtractor mExtractor;
    FrameTables mTables;
    gpu_scene::DeformationPass mDeformation;
    std::unique_ptr<ShadowMaps> mShadows;
    extract::ViewRequest mView;
    extract::ExtractedFrame* mFrame = nullptr;
};

} // namespace shutter::render
