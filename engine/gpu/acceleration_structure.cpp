// SPDX-License-Identifier: MIT
#include "engine/gpu/acceleration_structure.h"

#include "engine/core/check.h"
#include "engine/gpu/upload.h"

#include <algorithm>
#include <utility>

namespace shutter::gpu {

namespace {

constexpr VkBufferUsageFlags kInputUsage =
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

VkDeviceAddress alignUp(VkDeviceAddress value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

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

/// Everything one BLAS build needs; addresses into `geometries` stay valid while it lives.
struct BottomLevelBuild {
    std::vector<VkAccelerationStructureGeometryKHR> geometries;
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    VkAccelerationStructureBuildGeometryInfoKHR info{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
    VkAccelerationStructureBuildSizesInfoKHR sizes{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};

    BottomLevelBuild(const Device& device, const std::vector<TriangleGeometry>& mesh) {
        std::vector<uint32_t> counts;
        for (const TriangleGeometry& triangles : mesh) {
            geometries.push_back(describeTriangles(triangles));
            ranges.push_back({triangles.triangleCount, 0, 0, 0});
            counts.push_back(triangles.triangleCount);
        }
        info.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
        info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
        info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
        info.geometryCount = static_cast<uint32_t>(geometries.size());
        info.pGeometries = geometries.data();
        device.functions().getAccelerationStructureBuildSizes(
            device.handle(),
            VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
            &info,
            counts.data(),
            &sizes
        );
    }
};

} // namespace

AccelerationStructure::AccelerationStructure(
    Device& device, std::string name, VkAccelerationStructureTypeKHR type, VkDeviceSize bytes
)
    : mDevice(&device), mBuffer(
                            device,
                            name,
                            bytes,
                            VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR,
                            MemoryUse::Device
                        ) {
    VkAccelerationStructureCreateInfoKHR info{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
    info.buffer = mBuffer.handle();
    info.size = bytes;
    info.type = type;
    require(
        device.functions().createAccelerationStructure(device.handle(), &info, nullptr, &mHandle),
        fmt::format("creating the acceleration structure '{}'", name)
    );
    VkAccelerationStructureDeviceAddressInfoKHR address{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR};
    address.accelerationStructure = mHandle;
    mAddress = device.functions().getAccelerationStructureDeviceAddress(device.handle(), &address);
}

AccelerationStructure::~AccelerationStructure() {
    release();
}

AccelerationStructure::AccelerationStructure(AccelerationStructure&& other) noexcept {
    *this = std::move(other);
}

AccelerationStructure& AccelerationStructure::operator=(AccelerationStructure&& other) noexcept {
    if (this == &other)
        return *this;
    release();
    mDevice = std::exchange(other.mDevice, nullptr);
    mHandle = std::exchange(other.mHandle, VK_NULL_HANDLE);
    mAddress = std::exchange(other.mAddress, 0);
    mBuffer = std::move(other.mBuffer);
    return *this;
}

void AccelerationStructure::release() {
    if (!mHandle)
        return;
    // Queued before the buffer's own memory is, and so destroyed before it.
    mDevice->retire([device = mDevice->handle(),
                     handle = mHandle,
                     destroy = mDevice->functions().destroyAccelerationStructure] {
        destroy(device, handle, nullptr);
    });
    mHandle = VK_NULL_HANDLE;
}

std::vector<AccelerationStructure>
buildBottomLevel(Device& device, std::span<const std::vector<TriangleGeometry>> meshes) {
    std::vector<AccelerationStructure> structures(meshes.size());
    for (size_t i = 0; i < meshes.size(); ++i) {
        uint64_t triangleCount = 0;
        for (const TriangleGeometry& triangles : meshes[i])
            triangleCount += triangles.triangleCount;
        if (triangleCount == 0)
            continue;
        BottomLevelBuild build(device, meshes[i]);
        structures[i] = AccelerationStructure(
            device,
            fmt::format("BLAS {}", i),
            VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
            build.sizes.accelerationStructureSize
        );
        const VkDeviceSize alignment = device.minScratchAlignment();
        Buffer scratch(
            device,
            "BLAS scratch",
            build.sizes.buildScratchSize + alignment,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            MemoryUse::Device
        );
        build.info.dstAccelerationStructure = structures[i].handle();
        build.info.scratchData.deviceAddress = alignUp(scratch.address(), alignment);
        const auto* ranges = build.ranges.data();
        runOnce(device, [&](VkCommandBuffer commands) {
            device.functions().cmdBuildAccelerationStructures(commands, 1, &build.info, &ranges);
        });
    }
    return structures;
}

void TopLevel::prepare(Device& device, std::span<const Instance> instances) {
    mCount = static_cast<uint32_t>(instances.size());
    const bool grow = !mStructure || mCount > mCapacity;
    if (grow)
        mCapacity = std::max(mCount + mCount / 2, 16u);
    if (grow)
        mInstances = Buffer(
            device,
            "TLAS instances",
            mCapacity * sizeof(VkAccelerationStructureInstanceKHR),
            kInputUsage,
            MemoryUse::Upload
        );
    std::vector<VkAccelerationStructureInstanceKHR> records;
    records.reserve(mCount);
    for (const Instance& instance : instances) {
        SHUTTER_CHECK(instance.customIndex < (1u << 24), "{}", instance.customIndex);
        VkAccelerationStructureInstanceKHR record{};
        std::memcpy(&record.transform, instance.worldFromObject, sizeof(record.transform));
        record.instanceCustomIndex = instance.customIndex & 0xFFFFFFu;
        record.mask = 0xFF;
        record.flags =
            instance.cullDisabled ? VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR : 0;
        record.accelerationStructureReference = instance.bottomLevel;
        records.push_back(record);
    }
    mInstances.write(std::span<const VkAccelerationStructureInstanceKHR>(records));
    if (!grow)
        return;

    const auto build = describeBuild();
    VkAccelerationStructureBuildSizesInfoKHR sizes{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    device.functions().getAccelerationStructureBuildSizes(
        device.handle(),
        VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
        &build->info,
        &mCapacity,
        &sizes
    );
    mStructure = AccelerationStructure(
        device,
        "TLAS",
        VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR,
        sizes.accelerationStructureSize
    );
    mScratch = Buffer(
        device,
        "TLAS scratch",
        sizes.buildScratchSize + device.minScratchAlignment(),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        MemoryUse::Device
    );
}

std::unique_ptr<TopLevel::Build> TopLevel::describeBuild() const {
    auto build = std::make_unique<Build>();
    build->geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    auto& data = build->geometry.geometry.instances;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    data.data.deviceAddress = mInstances.address();
    build->info.type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    build->info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    build->info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    build->info.geometryCount = 1;
    build->info.pGeometries = &build->geometry;
    return build;
}

void TopLevel::record(const Device& device, VkCommandBuffer commands) {
    const auto build = describeBuild();
    build->info.dstAccelerationStructure = mStructure.handle();
    build->info.scratchData.deviceAddress =
        alignUp(mScratch.address(), device.minScratchAlignment());
    const VkAccelerationStructureBuildRangeInfoKHR range{mCount, 0, 0, 0};
    const auto* ranges = &range;
    device.functions().cmdBuildAccelerationStructures(commands, 1, &build->info, &ranges);
}

} // namespace shutter::gpu
