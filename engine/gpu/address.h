// SPDX-License-Identifier: MIT
// Device addresses in the tables that shaders read.
#pragma once

#include "engine/gpu/vulkan.h"
#include "engine/math/math.h"

namespace shutter::gpu {

/// A device address as the two words of which shaders make a reference.
[[nodiscard]] inline math::uvec2 splitAddress(VkDeviceAddress address) {
    return {static_cast<uint32_t>(address), static_cast<uint32_t>(address >> 32)};
}

[[nodiscard]] inline VkDeviceAddress joinAddress(const math::uvec2& words) {
    return VkDeviceAddress{words.y} << 32 | words.x;
}

} // namespace shutter::gpu
