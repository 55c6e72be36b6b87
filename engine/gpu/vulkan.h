// SPDX-License-Identifier: MIT
// Vulkan, how its failures are reported, and device addresses in tables that shaders read.
#pragma once

#include "engine/gpu/vulkan_functions.h"
#include "engine/math/math.h"

#include <vulkan/vulkan.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace shutter::gpu {

/// Out of memory, device lost, or a driver's refusal: nothing the caller can repair in place.
/// Thrown by everything in gpu/ and graph/; a program catches it once, where it turns errors into
/// an exit status. The message is one sentence.
class DeviceError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Throws DeviceError("<doing> failed: <result in words>") unless `result` is a success code.
void require(VkResult result, std::string_view doing);

/// "VK_ERROR_OUT_OF_DEVICE_MEMORY" and the like.
[[nodiscard]] std::string describe(VkResult result);

/// A device address as the two words (low, high) from which shaders make a reference.
[[nodiscard]] inline math::uvec2 splitAddress(VkDeviceAddress address) {
    return {static_cast<uint32_t>(address), static_cast<uint32_t>(address >> 32)};
}

[[nodiscard]] inline VkDeviceAddress joinAddress(const math::uvec2& words) {
    return VkDeviceAddress{words.y} << 32 | words.x;
}

} // namespace shutter::gpu
