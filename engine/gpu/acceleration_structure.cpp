// SPDX-License-Identifier: MIT
#include "engine/gpu/acceleration_structure.h"

#include "engine/core/check.h"

#include <algorithm>
#include <utility>

namespace shutter::gpu {

namespace {

/// A build of one geometry; `info` points into it, so it does not move.
struct SingleBuild {
    VkAccelerationStructureGeometryKHR geometry{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    VkAccelerationStructureBuildGeometryInfoKHR info{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};

    explicit SingleBuild(VkAccelerationStructureTypeKHR type) {
        info.type = type;
        info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
        info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
        info.geometryCount = 1;
        info.pGeometries = &geometry;
    }

    SingleBuild(const SingleBuild&) = delete;
    SingleBuild& operator=(const SingleBuild&) = delete;

    [[nodiscard]] VkAccelerationStructureBuildSizesInfoKHR
    measure(const Device& device, uint32_t count) const {
        VkAccelerationStructureBuildSizesInfoKHR sizes{
            VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
        device.functions().getAccelerationStructureBuildSizes(
            device.handle(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &count, &sizes
        );
        return sizes;
    }

    void record(
        const Device& device,
        VkCommandBuffer commands,
        const AccelerationStructure& target,
        VkDeviceAddress scratch,
        uint32_t count
    ) {
        info.dstAccelerationStructure = target.handle();
        info.scratchData.deviceAddress = scratch;
        const VkAccelerationStructureBuildRangeInfoKHR range{count, 0, 0, 0};
        const auto* ranges = &range;
        device.functions().cmdBuildAccelerationStructures(commands, 1, &info, &ranges);
    }
};

struct InstanceBuild : SingleBuild {
    explicit InstanceBuild(VkDeviceAddress instances)
        : SingleBuild(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR) {
        geometry = describeInstances(instances);
    }
};

struct BoxBuild : SingleBuild {
    explicit BoxBuild(VkDeviceAddress boxes)
        : SingleBuild(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR) {
        geometry = describeBoxes(boxes);
    }
};

} // namespace

AccelerationStructure::AccelerationStructure(
    Device& device, std::string name, VkAccelerationStructureTypeKHR type, VkDeviceSize bytes
)
    : AccelerationStructure(
          device,
          std::make_shared<const Buffer>(
              device,
              std::move(name),
              bytes,
              VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR,
              MemoryUse::Device
          ),
          0,
          bytes,
          type
      ) {}

AccelerationStructure::AccelerationStructure(
    Device& device,
    std::shared_ptr<const Buffer> storage,
    VkDeviceSize offset,
    VkDeviceSize bytes,
    VkAccelerationStructureTypeKHR type
)
    : mDevice(&device), mStorage(std::move(storage)) {
    VkAccelerationStructureCreateInfoKHR info{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
    info.buffer = mStorage->handle();
    info.offset = offset;
    info.size = bytes;
    info.type = type;
    require(
        device.functions().createAccelerationStructure(device.handle(), &info, nullptr, &mHandle),
        "creating an acceleration structure"
    );
    ++device.living().accelerationStructures;
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
    mStorage = std::move(other.mStorage);
    return *this;
}

void AccelerationStructure::release() {
    if (!mHandle)
        return;
    // Queued before the buffer's own memory is, and so destroyed before it.
    mDevice->retire([device = mDevice, handle = mHandle] {
        device->functions().destroyAccelerationStructure(device->handle(), handle, nullptr);
        --device->living().accelerationStructures;
    });
    mHandle = VK_NULL_HANDLE;
}

void Tlas::prepare(Device& device, std::span<const Instance> instances) {
    mCount = static_cast<uint32_t>(instances.size());
    const bool grow = !mStructure || mCount > mCapacity;
    if (grow)
        mCapacity = std::max(mCount + mCount / 2, 16u);
    if (grow)
        mInstances = Buffer(
            device,
            "TLAS instances",
            mCapacity * sizeof(VkAccelerationStructureInstanceKHR),
            kBuildInputUsage,
            MemoryUse::Stream
        );
    std::vector<VkAccelerationStructureInstanceKHR> records;
    records.reserve(mCount);
    for (const Instance& instance : instances)
        records.push_back(makeRecord(instance));
    mInstances.write(std::span<const VkAccelerationStructureInstanceKHR>(records));
    if (!grow)
        return;
    const auto sizes = InstanceBuild(mInstances.address()).measure(device, mCapacity);
    mStructure = AccelerationStructure(
        device,
        "TLAS",
        VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR,
        sizes.accelerationStructureSize
    );
    mScratch = makeScratch(device, "TLAS scratch", sizes.buildScratchSize);
}

void Tlas::record(const Device& device, VkCommandBuffer commands) const {
    InstanceBuild(mInstances.address())
        .record(device, commands, mStructure, alignScratch(device, mScratch), mCount);
}

void BoxBlas::prepare(Device& device, std::span<const BoxGeometry> boxes) {
    SHUTTER_CHECK(!boxes.empty(), "a structure of no boxes");
    mCount = static_cast<uint32_t>(boxes.size());
    const bool grow = mCount > mCapacity;
    if (grow) {
        mCapacity = std::max(mCount + mCount / 2, 16u);
        mBoxes = Buffer(
            device,
            "swept boxes",
            mCapacity * sizeof(BoxGeometry),
            kBuildInputUsage,
            MemoryUse::Stream
        );
    }
    mBoxes.write(boxes);
    if (!grow)
        return;
    const auto sizes = BoxBuild(mBoxes.address()).measure(device, mCapacity);
    mStructure = AccelerationStructure(
        device,
        "BLAS of boxes",
        VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
        sizes.accelerationStructureSize
    );
    mScratch = makeScratch(device, "box scratch", sizes.buildScratchSize);
}

void BoxBlas::record(const Device& device, VkCommandBuffer commands) {
    BoxBuild(mBoxes.address())
        .record(device, commands, mStructure, alignScratch(device, mScratch), mCount);
}

} // namespace shutter::gpu
