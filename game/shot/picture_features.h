// SPDX-License-Identifier: MIT
// The objects of FeatureSettings: what takes part in a picture besides its effects.
#pragma once

#include "engine/gpu/device.h"
#include "engine/render/renderer.h"
#include "game/shot/picture_settings.h"
#include "modules/shadows/shadows.h"

#include <vector>

namespace shutter::game {

/// Of one renderer's scene.
class PictureFeatures {
  public:
    /// \param scene outlives this
    PictureFeatures(gpu::Device& device, const gpu_scene::GpuScene& scene);

    /// For the frames to come.
    void configure(const FeatureSettings& settings);

    /// \param effects live as long as the set is used
    [[nodiscard]] render::FeatureSet listWith(const std::vector<render::Effect*>& effects) const;

  private:
    shadows::Shadows mShadows;
    std::vector<render::ShadingFeature*> mShading;
};

} // namespace shutter::game
