// SPDX-License-Identifier: MIT
// Structures that are built once, at load time, all of a scene together.
#include "engine/gpu/acceleration_structure.h"
#include "engine/gpu/memory_blocks.h"
#include "engine/gpu/upload.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

namespace shutter::gpu {

namespace {

/// Scratch memory of the builds of one submission: enough to saturate the GPU, too little to
/// trigger the watchdog of the system (TDR).
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
void measure(
    const Device& device,
    LoadBuild& build,
    VkAccelerationStructureTypeKHR type,
    Compaction compaction
) {
    build.info.type = type;
    build.info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    if (compaction == Compaction::Done)
        build.info.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
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
std::vector<AccelerationStructure> createStructures(
    Device& device,
    std::span<const VkDeviceSize> sizes,
    VkAccelerationStructureTypeKHR type,
    const std::string& name
) {
    std::vector<VkMemoryRequirements> needs;
    for (const VkDeviceSize bytes : sizes)
        needs.push_back({bytes, kStructureAlignment, UINT32_MAX});
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
    for (size_t i = 0; i < sizes.size(); ++i)
        structures.emplace_back(
            device, storage[plan.places[i].block], plan.places[i].offset, sizes[i], type
        );
    return structures;
}

/// Queries of what structures need once they are compacted.
class CompactedSizes {
  public:
    CompactedSizes(Device& device, uint32_t count) : mDevice(device), mCount(count) {
        VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        info.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
        info.queryCount = count;
        require(
            vkCreateQueryPool(device.handle(), &info, nullptr, &mQueries), "measuring structures"
        );
        vkResetQueryPool(device.handle(), mQueries, 0, count);
    }

    ~CompactedSizes() { vkDestroyQueryPool(mDevice.handle(), mQueries, nullptr); }

    CompactedSizes(const CompactedSizes&) = delete;
    CompactedSizes& operator=(const CompactedSizes&) = delete;

    void record(VkCommandBuffer commands, std::span<const AccelerationStructure> structures) const {
        std::vector<VkAccelerationStructureKHR> handles;
        for (const AccelerationStructure& structure : structures)
            handles.push_back(structure.handle());
        mDevice.functions().cmdWriteAccelerationStructuresProperties(
            commands,
            mCount,
            handles.data(),
            VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR,
            mQueries,
            0
        );
    }

    [[nodiscard]] std::vector<VkDeviceSize> read() const {
        std::vector<VkDeviceSize> sizes(mCount);
        require(
            vkGetQueryPoolResults(
                mDevice.handle(),
                mQueries,
                0,
                mCount,
                sizes.size() * sizeof(VkDeviceSize),
                sizes.data(),
                sizeof(VkDeviceSize),
                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT
            ),
            "measuring structures"
        );
        return sizes;
    }

  private:
    Device& mDevice;
    uint32_t mCount;
    VkQueryPool mQueries = VK_NULL_HANDLE;
};

/// How many from the first on share the scratch memory of one submission, at least one.
struct ScratchPlan {
    std::vector<VkDeviceSize> offsets; ///< of each build
    VkDeviceSize bytes = 0;
};

ScratchPlan planScratch(const Device& device, std::span<LoadBuild* const> builds) {
    ScratchPlan plan;
    for (const LoadBuild* build : builds) {
        const VkDeviceSize next = plan.bytes + build->sizes.buildScratchSize;
        if (!plan.offsets.empty() && next > kScratchBytes)
            break;
        plan.offsets.push_back(plan.bytes);
        plan.bytes = alignUp(next, device.minScratchAlignment());
    }
    return plan;
}

/// Builds some in one submission, and compacts them in a second one: only then it is known how
/// small they get.
std::vector<AccelerationStructure> buildSome(
    Device& device,
    std::span<LoadBuild* const> builds,
    const ScratchPlan& plan,
    Compaction compaction,
    const std::string& name
) {
    const VkAccelerationStructureTypeKHR type = builds.front()->info.type;
    std::vector<VkDeviceSize> sizes;
    for (const LoadBuild* build : builds)
        sizes.push_back(build->sizes.accelerationStructureSize);
    std::vector<AccelerationStructure> made = createStructures(device, sizes, type, name);
    const Buffer scratch = makeScratch(device, "scratch of structures", plan.bytes);
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
    std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
    for (size_t i = 0; i < builds.size(); ++i) {
        infos.push_back(builds[i]->info);
        infos.back().dstAccelerationStructure = made[i].handle();
        infos.back().scratchData.deviceAddress = alignScratch(device, scratch) + plan.offsets[i];
        ranges.push_back(builds[i]->ranges.data());
    }
    std::optional<CompactedSizes> compacted;
    if (compaction == Compaction::Done)
        compacted.emplace(device, static_cast<uint32_t>(builds.size()));
    runOnce(device, [&](VkCommandBuffer commands) {
        device.functions().cmdBuildAccelerationStructures(
            commands, static_cast<uint32_t>(infos.size()), infos.data(), ranges.data()
        );
        if (compacted) {
            fullBarrier(commands);
            compacted->record(commands, made);
        }
    });
    if (!compacted)
        return made;
    std::vector<AccelerationStructure> small =
        createStructures(device, compacted->read(), type, name);
    runOnce(device, [&](VkCommandBuffer commands) {
        for (size_t i = 0; i < small.size(); ++i) {
            VkCopyAccelerationStructureInfoKHR copy{
                VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR};
            copy.src = made[i].handle();
            copy.dst = small[i].handle();
            copy.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
            device.functions().cmdCopyAccelerationStructure(commands, &copy);
        }
    });
    return small;
}

/// One structure a build, empty for those without geometries.
std::vector<AccelerationStructure> buildAll(
    Device& device,
    std::vector<LoadBuild>& builds,
    VkAccelerationStructureTypeKHR type,
    Compaction compaction,
    const std::string& name
) {
    std::vector<LoadBuild*> needed;
    for (LoadBuild& build : builds) {
        if (build.geometries.empty())
            continue;
        measure(device, build, type, compaction);
        needed.push_back(&build);
    }
    std::vector<AccelerationStructure> made;
    while (made.size() < needed.size()) {
        const auto rest = std::span<LoadBuild* const>(needed).subspan(made.size());
        const ScratchPlan plan = planScratch(device, rest);
        auto some = buildSome(device, rest.first(plan.offsets.size()), plan, compaction, name);
        std::move(some.begin(), some.end(), std::back_inserter(made));
    }
    std::vector<AccelerationStructure> structures(builds.size());
    for (size_t i = 0, next = 0; i < builds.size(); ++i)
        if (!builds[i].geometries.empty())
            structures[i] = std::move(made[next++]);
    return structures;
}

} // namespace

std::vector<AccelerationStructure>
buildBlas(Device& device, std::span<const std::vector<TriangleGeometry>> meshes) {
    const bool isSoftware = device.info().kind == "software";
    return buildBlas(device, meshes, isSoftware ? Compaction::None : Compaction::Done);
}

std::vector<AccelerationStructure> buildBlas(
    Device& device, std::span<const std::vector<TriangleGeometry>> meshes, Compaction compaction
) {
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
        device,
        builds,
        VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
        compaction,
        "BLAS of meshes"
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
    return buildAll(
        device,
        builds,
        VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR,
        Compaction::None,
        "TLAS of one"
    );
}

} // namespace shutter::gpu
