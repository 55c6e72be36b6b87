// SPDX-License-Identifier: MIT
// Vulkan and the one way its failures are reported.
#pragma once

#include <vulkan/vulkan.h>

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

} // namespace shutter::gpu
