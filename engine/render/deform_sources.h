// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/scene/assets.h"
#include "shaders/render/deform_shared.h"

#include <cstdint>
#include <vector>

namespace shutter::render {

/// A device address as the two words shaders make a reference of.
[[nodiscard]] inline math::uvec2 splitAddress(VkDeviceAddress address) {
    return {static_cast<uint32_t>(address), static_cast<uint32_t>(address >> 32)};
}

[[nodiscard]] inline VkDeviceAddress joinAddress(const math::uvec2& words) {
    return VkDeviceAddress{words.y} << 32 | words.x;
}

/// What bends the vertices of one geometry, as shader::DeformJob has it.
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
    std::vector<DeformSource> mSources; ///< one a geometry: all meshes' primitives in order
};

} // namespace shutter::render
