// SPDX-License-Identifier: MIT
// Blended surfaces that one picture cannot represent over an exposure, as an overlay: they leave
// the raster and are drawn over the blurred picture at several instants
// (modules/motion_blur/resolved.md).
#pragma once

#include "engine/render/overlay.h"
#include "modules/glass/blended_layer.h"
#include "modules/glass/blended_layer_pass.h"

#include <array>
#include <string>
#include <vector>

namespace shutter::glass {

class Glass : public render::Overlay {
  public:
    /// \param scene outlives this
    Glass(gpu::Device& device, const gpu_scene::GpuScene& scene) : mPass(device, scene) {}

    [[nodiscard]] std::string name() const override { return "glass"; }

    [[nodiscard]] std::vector<uint32_t>
    findRows(const render::DecideContext& context, bool usesLens) const override;
    [[nodiscard]] core::Result<render::OverlayPlan> extract(const render::OverlayExtract& source
    ) override;
    [[nodiscard]] graph::ImageHandle declare(const render::OverlayContext& context) override;

  private:
    std::array<BlendedLayer, gpu::kMaxFramesInFlight> mLayers; ///< by slot
    BlendedLayerPass mPass;
};

} // namespace shutter::glass
