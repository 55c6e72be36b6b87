// SPDX-License-Identifier: MIT
// What a host's device must have enabled for the motion blur.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device_select.h"
#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <span>

namespace shutter::motion_blur {

/// The features to enable, as a chain for VkDeviceCreateInfo::pNext. A host adds its own in the
/// public structs (or copies the fields into a chain of its own: core shaderStorageImageExtended-
/// Formats; 1.2 bufferDeviceAddress and scalarBlockLayout; 1.3 synchronization2 and maintenance4;
/// more with rays, see the constructor).
class HostFeatures {
  public:
    /// \param rays how rays shall be traced, for methods of RayNeed::Any; None: methods without
    /// rays
    explicit HostFeatures(gpu::RayTier rays = gpu::RayTier::None);
    HostFeatures(const HostFeatures&) = delete;
    HostFeatures& operator=(const HostFeatures&) = delete;

    // Empty, so that hosts that include this are not warned of missing initialisers.
    VkPhysicalDeviceFeatures2 features{};
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};

    /// Valid as long as this is.
    [[nodiscard]] const void* chain() const { return &features; }

    /// Device extensions to enable; none without rays.
    [[nodiscard]] std::span<const char* const> extensions() const;

  private:
    gpu::RayTier mRays;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR mStructure{};
    VkPhysicalDeviceRayQueryFeaturesKHR mQuery{};
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR mPipeline{};
};

/// Switches the features on in a chain of the host's own, in whichever structures it holds for
/// them: those of a Vulkan version or of the extension that a feature comes from. Changes nothing
/// else. Error: names a feature that the chain has no structure for; nothing was changed.
[[nodiscard]] core::Status
addHostFeatures(VkPhysicalDeviceFeatures2& chain, gpu::RayTier rays = gpu::RayTier::None);

/// Whether the features are enabled in a chain that a device was made with. Error: names the first
/// that is not.
[[nodiscard]] core::Status checkEnabledFeatures(
    const VkPhysicalDeviceFeatures2& enabled, gpu::RayTier rays = gpu::RayTier::None
);

/// Whether the device could have the features enabled, and the queue family runs compute shaders;
/// one sentence that names what is missing where it cannot. What a host did enable Vulkan does not
/// tell anybody; the validation layer and checkEnabledFeatures() do.
[[nodiscard]] core::Status
checkHostDevice(VkPhysicalDevice device, uint32_t queueFamily, gpu::RayTier rays);

} // namespace shutter::motion_blur
