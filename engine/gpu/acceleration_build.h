// SPDX-License-Identifier: MIT
// What the builds of acceleration structures have in common; for this folder.
#pragma once

#include "engine/gpu/acceleration_structure.h"

namespace shutter::gpu {

inline constexpr VkBufferUsageFlags kBuildInputUsage =
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

[[nodiscard]] VkAccelerationStructureGeometryKHR describeTriangles(const TriangleGeometry& triangles
);
/// \param boxes address of BoxGeometry[]
[[nodiscard]] VkAccelerationStructureGeometryKHR describeBoxes(VkDeviceAddress boxes);
/// \param instances address of VkAccelerationStructureInstanceKHR[]
[[nodiscard]] VkAccelerationStructureGeometryKHR describeInstances(VkDeviceAddress instances);

[[nodiscard]] VkAccelerationStructureInstanceKHR makeRecord(const Instance& instance);

[[nodiscard]] VkDeviceSize alignUp(VkDeviceSize value, VkDeviceSize alignment);
/// With room to align its address by alignScratch().
[[nodiscard]] Buffer makeScratch(Device& device, const char* name, VkDeviceSize bytes);
[[nodiscard]] VkDeviceAddress alignScratch(const Device& device, const Buffer& scratch);

} // namespace shutter::gpu
