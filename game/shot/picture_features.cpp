// SPDX-License-Identifier: MIT
#include "game/shot/picture_features.h"

namespace shutter::game {

PictureFeatures::PictureFeatures(gpu::Device& device, const gpu_scene::GpuScene& scene)
    : mShadows(device, scene), mShading{&mShadows} {}

void PictureFeatures::configure(const FeatureSettings& settings) {
    mShadows.configure(settings.shadows);
}

render::FeatureSet PictureFeatures::listWith(const std::vector<render::Effect*>& effects) const {
    return {.shading = mShading, .effects = effects};
}

} // namespace shutter::game
