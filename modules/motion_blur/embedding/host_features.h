// SPDX-License-Identifier: MIT
// Required features of a host's device.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/vulkan.h"

#include <cstdint>

namespace shutter::motion_blur {

/// Enables the features in the host's chain, in the structures that it contains: those of a Vulkan
/// version or of the extension that a feature comes from. Changes nothing else. Error: names a
/// feature that the chain has no structure for; nothing was changed.
[[nodiscard]] core::Status addHostFeatures(VkPhysicalDeviceFeatures2& chain);

/// Whether the features are enabled in a chain that a device was made with. Error: names the first
/// that is not.
[[nodiscard]] core::Status checkEnabledFeatures(const VkPhysicalDeviceFeatures2& enabled);

/// Whether the device was made with subgroupSizeControl, which is not required: passes that diverge
/// are faster on GPUs with it.
[[nodiscard]] bool enablesSubgroupSizes(const VkPhysicalDeviceFeatures2& enabled);

/// Checks that the device supports the features and that the queue family has compute shaders.
/// Error: one sentence that names the missing feature. Vulkan has no query for enabled features;
/// the validation layer and checkEnabledFeatures() check those.
[[nodiscard]] core::Status checkHostDevice(VkPhysicalDevice device, uint32_t queueFamily);

} // namespace shutter::motion_blur
