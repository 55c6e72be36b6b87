// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/scene/assets.h"
#include "shaders/render/deform_shared.h"

#include <cstdint>
#include <vector>

namespace shutter::gpu_scene {

/// The deformation data of one geometry, as in shader::DeformJob.
struct DeformSource {
    math::uvec2 influences{0u};
    math::uvec2 deltas{0u};
    uint32_t influenceCount = 0;
    uint32_t targetCount = 0;
};

/// Joints, weights and morph targets of all meshes on the device. Nothing is there for assets
/// without them.
class DeformSources {
  public:
    DeformSources(gpu::Device& device, const scene::Assets& assets);

    [[nodiscard]] const DeformSource& operator[](uint32_t geometry) const {
        return mSources[geometry];
    }

  private:
    gpu::Buffer mInfluences;
    gpu::Buffer mDeltas;
    std::vector<DeformSource> mSources; ///< one per geometry: all meshes' primitives in order
};

} // namespace shutter::gpu_scene
