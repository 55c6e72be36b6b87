// SPDX-License-Identifier: MIT
// Draws the blended surfaces that left the raster (blended_layer.h) at several instants of
// the exposure, for an effect that composites them over its picture.
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/graph.h"
#include "engine/render/overlay.h"
#include "modules/glass/blended_layer.h"

#include <array>
#include <cstdint>

namespace shutter::glass {

class BlendedLayerPass {
  public:
    /// \param scene must outlive this
    BlendedLayerPass(gpu::Device& device, const gpu_scene::GpuScene& scene)
        : mDevice(device), mScene(scene) {}

    /// Declares the draws of one part; its share is left as it is. The slot's last frame must be
    /// finished. \param layer not empty; it must live until the pass has been recorded \param
    /// surfaces with BlendedLayer::readsInstants: shader::InstantSurfaces and its words
    [[nodiscard]] render::OverlayPart declare(
        const render::OverlayContext& context,
        const BlendedLayer& layer,
        graph::BufferHandle surfaces,
        uint32_t part
    );

  private:
    class Recorder;

    void preparePipelines();
    void upload(const BlendedLayer& layer, uint32_t slot);

    gpu::Device& mDevice;
    const gpu_scene::GpuScene& mScene;
    std::array<gpu::Pipeline, 2> mDraw; ///< by BlendedLayer::readsInstants
    gpu::Pipeline mReset;
    std::array<gpu::Buffer, gpu::kMaxFramesInFlight> mTables; ///< instants, then places
};

} // namespace shutter::glass
