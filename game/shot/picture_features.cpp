// SPDX-License-Identifier: MIT
#include "game/shot/picture_features.h"

#include "modules/particles/particle_extras.h"

namespace shutter::game {

std::span<const gltf::ExtraReader> listExtraReaders() {
    return {&particles::kParticleExtras, 1};
}

std::set<std::string> listFeatureIntermediates() {
    return {"particles"};
}

PictureFeatures::PictureFeatures(gpu::Device& device, const gpu_scene::GpuScene& scene)
    : mShadows(device, scene), mGlass(device, scene),
      mParticles(device, scene), mShading{&mShadows}, mOverlays{&mGlass, &mParticles} {}

void PictureFeatures::configure(const FeatureSettings& settings) {
    mShadows.configure(settings.shadows);
    mParticles.configure(settings.particles);
}

render::FeatureSet PictureFeatures::listWith(const std::vector<render::Effect*>& effects) const {
    return {.shading = mShading, .overlays = mOverlays, .effects = effects};
}

} // namespace shutter::game
