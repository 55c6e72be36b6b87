// SPDX-License-Identifier: MIT
// Many acceleration structures in one buffer: few allocations, and one barrier orders them all.
#pragma once

#include "engine/gpu/acceleration_structure.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace shutter::gpu {

/// The geometry of a BLAS: triangles or boxes, one kind only.
struct BlasDesc {
    struct Boxes {
        VkDeviceAddress boxes = 0; ///< of BoxGeometry[] on the device
        uint32_t count = 0;
    };

    std::vector<TriangleGeometry> triangles; ///< the geometry index counts these
    std::vector<Boxes> boxes;                ///< or these
};

enum class BuildAction : uint8_t {
    Keep,  ///< the last build
    Refit, ///< only vertices moved: the tree is refitted
    Build,
};

class StructureSet {
  public:
    StructureSet() = default;
    ~StructureSet();
    StructureSet(StructureSet&& other) noexcept;
    StructureSet& operator=(StructureSet&& other) noexcept;

    /// Allocates BLASes; record() builds them. Geometries without triangles or boxes are fine.
    /// \param refits allow BuildAction::Refit \return true: count and sizes are as before, so the
    /// last builds are still valid
    bool prepareBlas(Device& device, std::vector<BlasDesc> levels, bool refits = false);
    /// Allocates TLASes of one instance each and writes the instances. The GPU must have finished
    /// with the last ones.
    void prepareTlas(Device& device, std::span<const Instance> instances);
    /// Records the builds; the caller places barriers.
    /// \param actions one per structure
    void record(
        const Device& device, VkCommandBuffer commands, std::span<const BuildAction> actions
    ) const;
    /// Builds all.
    void record(const Device& device, VkCommandBuffer commands) const;

    [[nodiscard]] size_t count() const { return mStructures.size(); }

    [[nodiscard]] VkDeviceAddress address(size_t index) const { return mStructures[index].address; }

    [[nodiscard]] VkBuffer buffer() const { return mStorage.handle(); }

  private:
    /// One structure's build.
    struct Build {
        std::vector<VkAccelerationStructureGeometryKHR> geometries;
        std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    };

    struct Structure {
        VkAccelerationStructureKHR handle = VK_NULL_HANDLE;
        VkDeviceAddress address = 0;
        VkDeviceSize scratchOffset = 0;
    };

    [[nodiscard]] VkAccelerationStructureBuildGeometryInfoKHR describe(const Build& build) const;
    void create(Device& device);
    void release();

    Device* mDevice = nullptr;
    VkAccelerationStructureTypeKHR mType = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    bool mRefits = false;
    std::vector<Build> mBuilds;
    std::vector<Structure> mStructures;
    Buffer mStorage;
    Buffer mScratch;
    Buffer mInstances; ///< TLASes only
};

} // namespace shutter::gpu
