// SPDX-License-Identifier: MIT
#include "engine/core/check.h"
#include "engine/gpu/acceleration_structure.h"

namespace shutter::gpu {

static_assert(sizeof(BoxGeometry) == sizeof(VkAabbPositionsKHR));

VkAccelerationStructureGeometryKHR describeTriangles(const TriangleGeometry& triangles) {
    VkAccelerationStructureGeometryKHR geometry{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    geometry.flags = triangles.opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR
                                      : VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
    auto& data = geometry.geometry.triangles;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    data.vertexData.deviceAddress = triangles.vertices;
    data.vertexStride = triangles.vertexStride;
    data.maxVertex = triangles.vertexCount > 0 ? triangles.vertexCount - 1 : 0;
    data.indexType = VK_INDEX_TYPE_UINT32;
    data.indexData.deviceAddress = triangles.indices;
    return geometry;
}

VkAccelerationStructureGeometryKHR describeBoxes(VkDeviceAddress boxes) {
    VkAccelerationStructureGeometryKHR geometry{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_AABBS_KHR;
    geometry.flags = VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
    auto& data = geometry.geometry.aabbs;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR;
    data.data.deviceAddress = boxes;
    data.stride = sizeof(BoxGeometry);
    return geometry;
}

VkAccelerationStructureGeometryKHR describeInstances(VkDeviceAddress instances) {
    VkAccelerationStructureGeometryKHR geometry{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    auto& data = geometry.geometry.instances;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    data.data.deviceAddress = instances;
    return geometry;
}

VkAccelerationStructureInstanceKHR makeRecord(const Instance& instance) {
    SHUTTER_CHECK(instance.customIndex < (1u << 24), "{}", instance.customIndex);
    VkAccelerationStructureInstanceKHR record{};
    std::memcpy(&record.transform, instance.worldFromObject, sizeof(record.transform));
    record.instanceCustomIndex = instance.customIndex & 0xFFFFFFu;
    record.mask = instance.mask & 0xFFu;
    uint32_t flags = 0;
    if (instance.cullDisabled)
        flags |= VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
    if (instance.flipFacing)
        flags |= VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR;
    record.flags = flags & 0xFFu;
    record.accelerationStructureReference = instance.blas;
    return record;
}

VkDeviceSize alignUp(VkDeviceSize value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

Buffer makeScratch(Device& device, const char* name, VkDeviceSize bytes) {
    return Buffer(
        device,
        name,
        bytes + device.minScratchAlignment(),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        MemoryUse::Device
    );
}

VkDeviceAddress alignScratch(const Device& device, const Buffer& scratch) {
    return alignUp(scratch.address(), device.minScratchAlignment());
}

} // namespace shutter::gpu
