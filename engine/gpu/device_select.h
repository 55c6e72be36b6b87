// SPDX-License-Identifier: MIT
// Lists devices and their features, and selects one by name or by tier.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <optional>
#include <span>
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
    std::string name;   ///< as reported by the driver
    std::string driver; ///< driver's name and version in words
    std::string kind;   ///< "discrete", "integrated", "virtual", "software", "other"
    uint32_t apiVersion = 0;
    RayTier rayTier = RayTier::None; ///< the best it has, or the best that is allowed
    bool hasRayQuery = false;        ///< it could do RayTier::RayQuery
    bool hasRayPipeline = false;     ///< it could do RayTier::Pipeline
    bool tracesIndirect =
        false;                ///< launches of ray-tracing pipelines may read their size from memory
    std::string missing;      ///< why the engine cannot use it, empty where it can
    uint32_t queueFamily = 0; ///< used by the engine, if complete
    uint32_t timestampBits = 0;  ///< of that family's timestamps: how many count
    bool isPortable = false;     ///< it brings Vulkan to another interface (portability subset)
    bool hasRobustness2 = false; ///< accesses past the end of a buffer or image can read as 0
    bool interpolatesAnywhere =
        false; ///< shaders may interpolate elsewhere than at a pixel's centre
};

/// Makes an instance list portability drivers such as MoltenVK, which newer loaders hide by
/// default.
void listPortableDrivers(VkInstanceCreateFlags& flags, std::vector<const char*>& extensions);

/// Whether accesses past the end of bound resources are checked: loads give 0, stores do nothing.
enum class Bounds : uint8_t { Trusted, Checked };

/// The extensions that a device is made with.
/// \param presents it shows pictures on a window
[[nodiscard]] std::vector<const char*>
listDeviceExtensions(const DeviceInfo& device, bool presents, Bounds bounds);

/// A queue family, as far as one is chosen by it.
struct QueueFamily {
    VkQueueFlags flags = 0;
    uint32_t timestampBits = 0;
    bool presents = false; ///< on the surface in question
};

/// The first family for graphics, compute and timestamps that presents where it must. Nothing where
/// none does all of that: some devices draw in one family and show pictures in another.
[[nodiscard]] std::optional<uint32_t>
chooseQueueFamily(std::span<const QueueFamily> families, bool mustPresent);

/// What one device is and can do.
/// \param surface where it shall show pictures: it lacks something where it cannot; null: nowhere
[[nodiscard]] DeviceInfo
describeDevice(VkPhysicalDevice device, VkSurfaceKHR surface = VK_NULL_HANDLE);

/// All devices of the instance, in the driver's order.
[[nodiscard]] std::vector<DeviceInfo>
listDevices(VkInstance instance, VkSurfaceKHR surface = VK_NULL_HANDLE);

/// The best tier of the device from `best` down.
[[nodiscard]] RayTier chooseTier(const DeviceInfo& device, RayTier best);

/// `wanted` is empty (software last, then rays of any tier before none, then discrete before
/// integrated before virtual, then the better tier), an index of `devices`, or a part of a name
/// (case does not matter). Error: what there is to choose from.
[[nodiscard]] core::Result<DeviceInfo>
chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& wanted);

/// A sentence for each device that would have been chosen before `chosen` if it lacked nothing.
[[nodiscard]] std::vector<std::string>
describePassedOver(const std::vector<DeviceInfo>& devices, const DeviceInfo& chosen);

[[nodiscard]] const char* describe(RayTier tier);
/// All tiers of the device in words, best first; "none" where it has none.
[[nodiscard]] std::string describeTiers(const DeviceInfo& device);

} // namespace shutter::gpu
