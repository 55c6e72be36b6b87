// SPDX-License-Identifier: MIT
// The objects of FeatureSettings: what takes part in a picture besides its effects.
#pragma once

#include "engine/gltf/extras.h"
#include "engine/gpu/device.h"
#include "engine/render/renderer.h"
#include "game/shot/picture_settings.h"
#include "modules/glass/glass.h"
#include "modules/particles/particles.h"
#include "modules/shadows/shadows.h"

#include <set>
#include <span>
#include <string>
#include <vector>

namespace shutter::game {

/// Readers of the features' components, for gltf::loadGltf().
[[nodiscard]] std::span<const gltf::ExtraReader> listExtraReaders();

/// Intermediates that features publish, for `--aov` and debug views.
[[nodiscard]] std::set<std::string> listFeatureIntermediates();

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
    glass::Glass mGlass;
    particles::Particles mParticles;
    std::vector<render::ShadingFeature*> mShading;
    std::vector<render::Overlay*> mOverlays; ///< in the order in which they are drawn
};

} // namespace shutter::game
