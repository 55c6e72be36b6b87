// SPDX-License-Identifier: MIT
// Shadows of lights as a feature of shading (README.md).
#pragma once

#include "engine/render/per_slot.h"
#include "engine/render/shading_feature.h"
#include "modules/shadows/shadow_maps.h"
#include "modules/shadows/shadow_settings.h"

#include <array>
#include <optional>

namespace shutter::shadows {

class Shadows : public render::ShadingFeature {
  public:
    /// \param scene outlives this
    Shadows(gpu::Device& device, const gpu_scene::GpuScene& scene);

    /// For the frames to come; settings must be valid.
    void configure(const ShadowSettings& settings) { mSettings = settings; }

    /// Error: the maps do not fit an image of the device.
    [[nodiscard]] core::Result<render::Shading> extract(const render::RasterExtract& raster
    ) override;
    [[nodiscard]] graph::BufferHandle declare(const render::RasterContext& context) override;
    void endFrame() override;

  private:
    [[nodiscard]] ShadowMaps& mapsOf(render::RasterKind kind, uint32_t slot) {
        return mMaps.at(size_t(kind)).use(slot);
    }

    gpu::Device& mDevice;
    const gpu_scene::GpuScene& mScene;
    ShadowSettings mSettings;
    std::optional<ShadowPipelines> mPipelines; ///< made by the first frame with shadows
    std::array<render::PerSlot<ShadowMaps>, render::kRasterKinds> mMaps;
};

} // namespace shutter::shadows
