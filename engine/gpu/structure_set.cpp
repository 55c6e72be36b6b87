// SPDX-License-Identifier: MIT
#include "engine/gpu/structure_set.h"

#include "engine/core/check.h"
#include "engine/gpu/acceleration_structure.h"

#include <algorithm>
#include <utility>

namespace shutter::gpu {

namespace {

/// Compares the inputs that determine the size of a structure.
bool isAlike(
    const VkAccelerationStructureGeometryKHR& a, const VkAccelerationStructureGeometryKHR& b
) {
    if (a.geometryType != b.geometryType || a.flags != b.flags)
        return false;
    return a.geometryType != VK_GEOMETRY_TYPE_TRIANGLES_KHR ||
           a.geometry.triangles.maxVertex == b.geometry.triangles.maxVertex;
}

bool isAlike(
    const VkAccelerationStructureBuildRangeInfoKHR& a,
    const VkAccelerationStructureBuildRangeInfoKHR& b
) {
    return a.primitiveCount == b.primitiveCount;
}

template <class T> bool areAlike(const std::vector<T>& a, const std::vector<T>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const T& left, const T& right) {
        return isAlike(left, right);
    });
}

} // namespace

StructureSet::~StructureSet() {
    release();
}

StructureSet::StructureSet(StructureSet&& other) noexcept {
    *this = std::move(other);
}

StructureSet& StructureSet::operator=(StructureSet&& other) noexcept {
    if (this == &other)
        return *this;
    release();
    mDevice = std::exchange(other.mDevice, nullptr);
    mType = other.mType;
    mRefits = other.mRefits;
    mBuilds = std::exchange(other.mBuilds, {});
    mStructures = std::exchange(other.mStructures, {});
    mStorage = std::move(other.mStorage);
    mScratch = std::move(other.mScratch);
    mInstances = std::move(other.mInstances);
    return *this;
}

void StructureSet::release() {
    // Queued before the buffer's own memory is, and so destroyed before it.
    for (const Structure& structure : mStructures)
        mDevice->retire([device = mDevice, handle = structure.handle] {
            device->functions().destroyAccelerationStructure(device->handle(), handle, nullptr);
            --device->living().accelerationStructures;
        });
    mStructures.clear();
}

VkAccelerationStructureBuildGeometryInfoKHR StructureSet::describe(const Build& build) const {
    VkAccelerationStructureBuildGeometryInfoKHR info{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
    info.type = mType;
    info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    if (mRefits)
        info.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = static_cast<uint32_t>(build.geometries.size());
    info.pGeometries = build.geometries.data();
    return info;
}

bool StructureSet::prepareBlas(Device& device, std::vector<BlasDesc> levels, bool refits) {
    std::vector<Build> builds;
    for (const BlasDesc& level : levels) {
        SHUTTER_CHECK(level.triangles.empty() || level.boxes.empty(), "two kinds in a level");
        Build& build = builds.emplace_back();
        for (const TriangleGeometry& triangles : level.triangles) {
            build.geometries.push_back(describeTriangles(triangles));
            build.ranges.push_back({triangles.triangleCount, 0, 0, 0});
        }
        for (const BlasDesc::Boxes& boxes : level.boxes) {
            build.geometries.push_back(describeBoxes(boxes.boxes));
            build.ranges.push_back({boxes.count, 0, 0, 0});
        }
    }
    const bool same =
        mDevice == &device && mRefits == refits &&
        mType == VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR &&
        std::equal(
            builds.begin(),
            builds.end(),
            mBuilds.begin(),
            mBuilds.end(),
            [](const Build& a, const Build& b) {
                return areAlike(a.ranges, b.ranges) && areAlike(a.geometries, b.geometries);
            }
        );
    mBuilds = std::move(builds);
    if (same)
        return true;
    mType = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    mRefits = refits;
    create(device);
    return false;
}

void StructureSet::prepareTlas(Device& device, std::span<const Instance> instances) {
    std::vector<VkAccelerationStructureInstanceKHR> records;
    records.reserve(instances.size());
    for (const Instance& instance : instances)
        records.push_back(makeRecord(instance));
    mInstances = Buffer(
        device,
        "instances of one each",
        records.size() * sizeof(VkAccelerationStructureInstanceKHR),
        kBuildInputUsage,
        MemoryUse::Stream
    );
    mInstances.write(std::span<const VkAccelerationStructureInstanceKHR>(records));
    mBuilds.clear();
    for (size_t i = 0; i < records.size(); ++i) {
        Build& build = mBuilds.emplace_back();
        build.geometries.push_back(
            describeInstances(mInstances.address() + i * sizeof(VkAccelerationStructureInstanceKHR))
        );
        build.ranges.push_back({1, 0, 0, 0});
    }
    mType = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    mRefits = false;
    create(device);
}

void StructureSet::create(Device& device) {
    release();
    mDevice = &device;
    std::vector<VkDeviceSize> offsets;
    std::vector<VkDeviceSize> sizes;
    VkDeviceSize end = 0;
    VkDeviceSize scratchEnd = 0;
    for (const Build& build : mBuilds) {
        const auto info = describe(build);
        std::vector<uint32_t> counts;
        for (const auto& range : build.ranges)
            counts.push_back(range.primitiveCount);
        VkAccelerationStructureBuildSizesInfoKHR needed{
            VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
        device.functions().getAccelerationStructureBuildSizes(
            device.handle(),
            VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
            &info,
            counts.data(),
            &needed
        );
        offsets.push_back(end);
        sizes.push_back(needed.accelerationStructureSize);
        end = alignUp(end + needed.accelerationStructureSize, kStructureAlignment);
        mStructures.push_back({VK_NULL_HANDLE, 0, scratchEnd});
        scratchEnd = alignUp(
            scratchEnd + std::max(needed.buildScratchSize, needed.updateScratchSize),
            device.minScratchAlignment()
        );
    }
    mStorage = Buffer(
        device,
        "acceleration structures",
        end,
        VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR,
        MemoryUse::Device
    );
    mScratch = makeScratch(device, "scratch of acceleration structures", scratchEnd);
    for (size_t i = 0; i < mStructures.size(); ++i) {
        VkAccelerationStructureCreateInfoKHR info{
            VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
        info.buffer = mStorage.handle();
        info.offset = offsets[i];
        info.size = sizes[i];
        info.type = mType;
        require(
            device.functions().createAccelerationStructure(
                device.handle(), &info, nullptr, &mStructures[i].handle
            ),
            fmt::format("creating acceleration structure {} of {}", i, mStructures.size())
        );
        ++device.living().accelerationStructures;
        VkAccelerationStructureDeviceAddressInfoKHR address{
            VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR};
        address.accelerationStructure = mStructures[i].handle;
        mStructures[i].address =
            device.functions().getAccelerationStructureDeviceAddress(device.handle(), &address);
    }
}

void StructureSet::record(
    const Device& device, VkCommandBuffer commands, std::span<const BuildAction> actions
) const {
    SHUTTER_CHECK_EQ(actions.size(), mStructures.size());
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
    std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
    for (size_t i = 0; i < mStructures.size(); ++i) {
        if (actions[i] == BuildAction::Keep)
            continue;
        auto& info = infos.emplace_back(describe(mBuilds[i]));
        info.dstAccelerationStructure = mStructures[i].handle;
        info.scratchData.deviceAddress =
            alignScratch(device, mScratch) + mStructures[i].scratchOffset;
        if (actions[i] == BuildAction::Refit) {
            SHUTTER_CHECK(mRefits, "structure {} was not made to be refitted", i);
            info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
            info.srcAccelerationStructure = mStructures[i].handle;
        }
        ranges.push_back(mBuilds[i].ranges.data());
    }
    if (!infos.empty())
        device.functions().cmdBuildAccelerationStructures(
            commands, static_cast<uint32_t>(infos.size()), infos.data(), ranges.data()
        );
}

void StructureSet::record(const Device& device, VkCommandBuffer commands) const {
    record(device, commands, std::vector<BuildAction>(mStructures.size(), BuildAction::Build));
}

} // namespace shutter::gpu
