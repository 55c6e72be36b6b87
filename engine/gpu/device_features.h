// SPDX-License-Identifier: MIT
// The features that the engine enables, in one list: a device is searched for them, and then made
// with them.
#pragma once

#include "engine/gpu/vulkan.h"

#include <string>

namespace shutter::gpu {

/// The structs of core Vulkan that hold features, chained. Does not move: the chain points into it.
struct DeviceFeatures {
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};

    DeviceFeatures();
    DeviceFeatures(const DeviceFeatures&) = delete;
    DeviceFeatures& operator=(const DeviceFeatures&) = delete;

    /// Enables the features that the engine needs without rays, for vkCreateDevice. Ray features
    /// are in separate structs (device.cpp).
    void enableNeeded();

    /// For what vkGetPhysicalDeviceFeatures2 has filled in.
    /// \return the names of required features that are not set; empty if all are
    [[nodiscard]] std::string findMissing() const;
};

} // namespace shutter::gpu
