// SPDX-License-Identifier: MIT
// Draws the blended surfaces that left the raster (extract/blended_layer.h) at several instants of
// the exposure, for an effect that composites them over its picture.
#pragma once

#include "engine/extract/blended_layer.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/graph.h"
#include "engine/render/contexts.h"

#include <array>
#include <cstdint>

namespace shutter::render {

/// One part of the exposure: sums over its instants, each with the weight of an instant of the
/// whole exposure. Images that begin with BlendedLayer::sizePx.
struct BlendedPart {
    graph::ImageHandle color;   ///< RGBA16F: premultiplied
    graph::ImageHandle opacity; ///< RGBA16F: in red
};

class BlendedLayerPass {
  public:
    /// \param scene must outlive this
    BlendedLayerPass(gpu::Device& device, const gpu_scene::GpuScene& scene)
        : mDevice(device), mScene(scene) {}

    /// Declares the draws of one part. The slot's last frame must be finished.
    /// \param layer not empty; it must live until the pass has been recorded
    /// \param surfaces with BlendedLayer::readsInstants: shader::InstantSurfaces and its words
    [[nodiscard]] BlendedPart declare(
        const PictureContext& context,
        const extract::BlendedLayer& layer,
        graph::BufferHandle surfaces,
        uint32_t part
    );

  private:
    class Recorder;

    void preparePipelines();
    void upload(const extract::BlendedLayer& layer, uint32_t slot);

    gpu::Device& mDevice;
    const gpu_scene::GpuScene& mScene;
    std::array<gpu::Pipeline, 2> mDraw; ///< by BlendedLayer::readsInstants
    gpu::Pipeline mReset;
    std::array<gpu::Buffer, gpu::kMaxFramesInFlight> mTables; ///< instants, then places
};

} // namespace shutter::render
