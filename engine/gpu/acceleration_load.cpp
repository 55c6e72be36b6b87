// SPDX-License-Identifier: MIT
// Structures that are built once, at load time, all of a scene together.
#include "engine/gpu/acceleration_structure.h"
#include "engine/gpu/memory_blocks.h"
#include "engine/gpu/upload.h"

#include <algorithm>
#include <memory>

namespace shutter::gpu {

namespace {

/// Scratch memory of the builds of one submission: as much work as keeps a device busy, and no more
/// than it does before the system takes it for hung.
constexpr VkDeviceSize kScratchBytes = VkDeviceSize(64) << 20;

struct LoadBuild {
    std::vector<VkAccelerationStructureGeometryKHR> geometries; ///< none: no structure
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    VkAccelerationStructureBuildGeometryInfoKHR info{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
    VkAccelerationStructureBuildSizesInfoKHR sizes{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
};

/// Fills in info and sizes.
void measure(const Device& device, LoadBuild& build, VkAccelerationStructureTypeKHR type) {
    build.info.type = type;
    build.info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    build.info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    build.info.geometryCount = static_cast<uint32_t>(build.geometries.size());
    build.info.pGeometries = build.geometries.data();
    std::vector<uint32_t> counts;
    for (const auto& range : build.ranges)
        counts.push_back(range.primitiveCount);
    device.functions().getAccelerationStructureBuildSizes(
        device.handle(),
        VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
        &build.info,
        counts.data(),
        &build.sizes
    );
}

/// Structures of these sizes in as few buffers as hold them.
std::vector<AccelerationStructure>
createStructures(Device& device, std::span<LoadBuild* const> builds, const std::string& name) {
    std::vector<VkMemoryRequirements> needs;
    for (const LoadBuild* build : builds)
        needs.push_back({build->sizes.accelerationStructureSize, kStructureAlignment, UINT32_MAX});
    const BlockPlan plan = planBlocks(needs);
    std::vector<std::shared_ptr<const Buffer>> storage;
    for (const BlockPlan::Block& block : plan.blocks)
        storage.push_back(std::make_shared<const Buffer>(
            device,
            name,
            block.bytes,
            VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR,
            MemoryUse::Device
        ));
    std::vector<AccelerationStructure> structures;
    for (size_t i = 0; i < builds.size(); ++i)
        structures.emplace_back(
            device,
            storage[plan.places[i].block],
            plan.places[i].offset,
            builds[i]->sizes.accelerationStructureSize,
            builds[i]->info.type
        );
    return structures;
}

/// Builds as many from the first on as share the scratch memory of one submission, at least one.
/// \return how many
size_t buildSome(Device& device, std::span<LoadBuild* const> builds) {
    std::vector<VkDeviceSize> offsets;
    VkDeviceSize end = 0;
    for (const LoadBuild* build : builds) {
        const VkDeviceSize next = end + build->sizes.buildScratchSize;
        if (!offsets.empty() && next > kScratchBytes)
            break;
        offsets.push_back(end);
        end = alignUp(next, device.minScratchAlignment());
    }
    const Buffer scratch = makeScratch(device, "scratch of structures", end);
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
    std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
    for (size_t i = 0; i < offsets.size(); ++i) {
        infos.push_back(builds[i]->info);
        infos.back().scratchData.deviceAddress = alignScratch(device, scratch) + offsets[i];
        ranges.push_back(builds[i]->ranges.data());
    }
    runOnce(device, [&](VkCommandBuffer commands) {
        device.functions().cmdBuildAccelerationStructures(
            commands, static_cast<uint32_t>(infos.size()), infos.data(), ranges.data()
        );
    });
    return offsets.size();
}

/// One structure a build, empty for those without geometries.
std::vector<AccelerationStructure> buildAll(
    Device& device,
    std::vector<LoadBuild>& builds,
    VkAccelerationStructureTypeKHR type,
    const std::string& name
) {
    std::vector<LoadBuild*> needed;
    for (LoadBuild& build : builds) {
        if (build.geometries.empty())
            continue;
        measure(device, build, type);
        needed.push_back(&build);
    }
    std::vector<AccelerationStructure> made = createStructures(device, needed, name);
    for (size_t i = 0; i < made.size(); ++i)
        needed[i]->info.dstAccelerationStructure = made[i].handle();
    for (size_t done = 0; done < needed.size();)
        done += buildSome(device, std::span<LoadBuild* const>(needed).subspan(done));
    std::vector<AccelerationStructure> structures(builds.size());
    for (size_t i = 0, next = 0; i < builds.size(); ++i)
        if (!builds[i].geometries.empty())
            structures[i] = std::move(made[next++]);
    return structures;
}

} // namespace

std::vector<AccelerationStructure>
buildBlas(Device& device, std::span<const std::vector<TriangleGeometry>> meshes) {
    std::vector<LoadBuild> builds(meshes.size());
    for (size_t i = 0; i < meshes.size(); ++i) {
        const bool hasTriangles =
            std::any_of(meshes[i].begin(), meshes[i].end(), [](const TriangleGeometry& triangles) {
                return triangles.triangleCount > 0;
            });
        if (!hasTriangles)
            continue;
        for (const TriangleGeometry& triangles : meshes[i]) {
            builds[i].geometries.push_back(describeTriangles(triangles));
            builds[i].ranges.push_back({triangles.triangleCount, 0, 0, 0});
        }
    }
    return buildAll(
        device, builds, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, "BLAS of meshes"
    );
}

std::vector<AccelerationStructure> buildTlas(Device& device, std::span<const Instance> instances) {
    std::vector<VkAccelerationStructureInstanceKHR> records;
    records.reserve(instances.size());
    for (const Instance& instance : instances)
        records.push_back(makeRecord(instance));
    Buffer buffer(
        device,
        "TLAS instances",
        records.size() * sizeof(VkAccelerationStructureInstanceKHR),
        kBuildInputUsage,
        MemoryUse::Stream
    );
    buffer.write(std::span<const VkAccelerationStructureInstanceKHR>(records));
    std::vector<LoadBuild> builds(instances.size());
    for (size_t i = 0; i < builds.size(); ++i) {
        builds[i].geometries.push_back(
            describeInstances(buffer.address() + i * sizeof(VkAccelerationStructureInstanceKHR))
        );
        builds[i].ranges.push_back({1, 0, 0, 0});
    }
    return buildAll(device, builds, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, "TLAS of one");
}

} // namespace shutter::gpu
