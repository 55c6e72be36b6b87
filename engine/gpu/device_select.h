// SPDX-License-Identifier: MIT
// Which devices there are, what each can do, and which one a name or the tiers choose.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <string>
#include <vector>

namespace shutter::gpu {

/// How rays can be traced on a device, best first.
enum class RayTier : uint8_t {
    RayQuery, ///< VK_KHR_ray_query: any shader may trace
    None,     ///< methods that need rays are refused
};

struct DeviceInfo {
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    std::string name;   ///< as the driver says it
    std::string driver; ///< driver's name and version in words
    std::string kind;   ///< "discrete", "integrated", "virtual", "software", "other"
    uint32_t apiVersion = 0;
    RayTier rayTier = RayTier::None;
    std::string missing; ///< why the engine cannot use it, empty where it can
};

/// All devices of the instance, in the driver's order.
[[nodiscard]] std::vector<DeviceInfo> listDevices(VkInstance instance);

/// `wanted` is empty (best tier, then discrete before integrated before software), an index of
/// `devices`, or a part of a name (case does not matter). Error: what there is to choose from.
[[nodiscard]] core::Result<DeviceInfo>
chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& wanted);

[[nodiscard]] const char* describe(RayTier tier);

} // namespace shutter::gpu
