// SPDX-License-Identifier: MIT
// Transparency of a frame: plans, draws and composites the blended surfaces that leave the raster
// over the blurred picture, and gives particles the instants of their background.
#pragma once

#include "engine/extract/particle_instants.h"
#include "engine/render/blended_layer.h"
#include "engine/render/contexts.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/passes/composite.h"

#include <array>
#include <optional>
#include <vector>

namespace shutter::motion_blur {

class BlendedSurfaces {
  public:
    /// \param scene must outlive this
    BlendedSurfaces(gpu::Device& device, const gpu_scene::GpuScene& scene)
        : mDevice(device), mScene(scene), mLayer(device, scene), mComposite(device) {}

    /// Plans the layer of a frame, and at which instants its particles are hidden. \param limits
    /// surfaceBytes is filled in
    void extract(const render::ExtractContext& context, extract::LayerLimits limits);

    /// Surfaces that the method must provide (MotionBlurInputs::surfaces).
    [[nodiscard]] std::vector<shader::InstantSurfaces> wanted(uint32_t slot) const;

    /// Draws the layer over the blurred picture of the frame that extract() was called for, and
    /// fills PictureContext::particleInstants. \return the picture with the layer
    [[nodiscard]] graph::ImageHandle
    declare(render::PictureContext& context, const MotionBlurOutputs& blurred);

    /// Adds "blended instants" and "blended bytes", the memory that the slot's layer took, and
    /// "particle instants" and "particle bytes" likewise; nothing where there was none.
    void count(uint32_t slot, render::Counters& counters) const;

  private:
    struct Plan {
        extract::BlendedLayer layer;
        /// Where particles are hidden at instants; nothing: by the raster's depth.
        std::optional<shader::InstantSurfaces> particles;

        [[nodiscard]] bool layerReadsInstants() const {
            return !layer.empty() && layer.readsInstants;
        }

        /// The layer's surfaces are where the particles' would be.
        [[nodiscard]] bool sharesSurfaces() const;
    };

    graph::ImageHandle declareLayer(
        const render::PictureContext& context,
        const extract::BlendedLayer& layer,
        graph::ImageHandle blurred,
        graph::BufferHandle surfaces
    );

    gpu::Device& mDevice;
    const gpu_scene::GpuScene& mScene;
    std::array<Plan, gpu::kMaxFramesInFlight> mPlans; ///< by slot
    render::BlendedLayerPass mLayer;
    Composite mComposite;
};

} // namespace shutter::motion_blur
