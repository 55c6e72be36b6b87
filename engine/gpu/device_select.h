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
    Pipeline, ///< VK_KHR_ray_tracing_pipeline: shaders of such a pipeline may
    None,     ///< methods that need rays are refused
};

struct DeviceInfo {
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    std::string name;   ///< as the driver says it
    std::string driver; ///< driver's name and version in words
    std::string kind;   ///< "discrete", "integrated", "virtual", "software", "other"
    uint32_t apiVersion = 0;
    RayTier rayTier = RayTier::None; ///< the best it has, or the best that is allowed
    bool hasRayQuery = false;        ///< it could do RayTier::RayQuery
    bool hasRayPipeline = false;     ///< it could do RayTier::Pipeline
    bool tracesIndirect =
        false;           ///< launches of ray-tracing pipelines may read their size from memory
    std::string missing; ///< why the engine cannot use it, empty where it can
};

/// What one device is and can do.
[[nodiscard]] DeviceInfo describeDevice(VkPhysicalDevice device);

/// All devices of the instance, in the driver's order.
[[nodiscard]] std::vector<DeviceInfo> listDevices(VkInstance instance);

/// The best tier of the device from `best` down.
[[nodiscard]] RayTier chooseTier(const DeviceInfo& device, RayTier best);

/// `wanted` is empty (software last, then rays of any tier before none, then discrete before
/// integrated before virtual, then the better tier), an index of `devices`, or a part of a name
/// (case does not matter). Error: what there is to choose from.
[[nodiscard]] core::Result<DeviceInfo>
chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& wanted);

[[nodiscard]] const char* describe(RayTier tier);
/// All tiers of the device in words, best first; "none" where it has none.
[[nodiscard]] std::string describeTiers(const DeviceInfo& device);

} // namespace shutter::gpu
