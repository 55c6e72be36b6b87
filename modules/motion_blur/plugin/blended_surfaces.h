// SPDX-License-Identifier: MIT
// The blended surfaces of a frame that leave the raster: planned, drawn and composited over the
// blurred picture.
#pragma once

#include "engine/extract/blended_layer.h"
#include "engine/render/blended_layer.h"
#include "engine/render/post_effect.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/passes/composite.h"

#include <array>
#include <optional>

namespace shutter::motion_blur {

class BlendedSurfaces {
  public:
    /// \param scene must outlive this
    BlendedSurfaces(gpu::Device& device, const gpu_scene::GpuScene& scene)
        : mDevice(device), mScene(scene), mLayer(device, scene), mComposite(device) {}

    /// Plans the layer of a frame. \param limits surfaceBytes is filled in
    void extract(const render::ExtractContext& context, extract::LayerLimits limits);

    /// What the method must leave for it (MotionBlurInputs::surfaces).
    [[nodiscard]] std::optional<shader::InstantSurfaces> wanted(uint32_t slot) const;

    /// Draws the layer over the blurred picture of the frame that extract() was called for.
    /// \return the picture with it
    [[nodiscard]] graph::ImageHandle
    declare(const render::PostContext& context, const MotionBlurOutputs& blurred);

    /// Adds "blended instants" and "blended bytes", the memory that the slot's layer took; nothing
    /// where it had none.
    void count(uint32_t slot, render::Counters& counters) const;

  private:
    gpu::Device& mDevice;
    const gpu_scene::GpuScene& mScene;
    std::array<extract::BlendedLayer, gpu::kMaxFramesInFlight> mPlans; ///< by slot
    render::BlendedLayerPass mLayer;
    Composite mComposite;
};

} // namespace shutter::motion_blur
