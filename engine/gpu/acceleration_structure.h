// SPDX-License-Identifier: MIT
// Bottom and top level acceleration structures (VK_KHR_acceleration_structure).
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace shutter::gpu {

/// Indexed triangles of one primitive, in buffers already on the device.
struct TriangleGeometry {
    VkDeviceAddress vertices = 0; ///< of the first position: 3 floats at the start of each vertex
    uint32_t vertexStride = 0;    ///< bytes
    uint32_t vertexCount = 0;
    VkDeviceAddress indices = 0; ///< 32-bit, 3 a triangle
    uint32_t triangleCount = 0;
    bool opaque = true; ///< false: candidates are shown to the shader (alpha mask)
};

class AccelerationStructure {
  public:
    AccelerationStructure() = default;
    /// Creates it in a dedicated buffer.
    AccelerationStructure(
        Device& device, std::string name, VkAccelerationStructureTypeKHR type, VkDeviceSize bytes
    );
    /// In a part of a buffer, which lives as long as one of the structures in it.
    /// \param offset a multiple of kStructureAlignment
    AccelerationStructure(
        Device& device,
        std::shared_ptr<const Buffer> storage,
        VkDeviceSize offset,
        VkDeviceSize bytes,
        VkAccelerationStructureTypeKHR type
    );
    ~AccelerationStructure();
    AccelerationStructure(AccelerationStructure&& other) noexcept;
    AccelerationStructure& operator=(AccelerationStructure&& other) noexcept;

    [[nodiscard]] VkAccelerationStructureKHR handle() const { return mHandle; }

    [[nodiscard]] VkDeviceAddress address() const { return mAddress; }

    [[nodiscard]] VkBuffer buffer() const { return mStorage->handle(); }

    [[nodiscard]] explicit operator bool() const { return mHandle != VK_NULL_HANDLE; }

  private:
    void release();

    Device* mDevice = nullptr;
    std::shared_ptr<const Buffer> mStorage;
    VkAccelerationStructureKHR mHandle = VK_NULL_HANDLE;
    VkDeviceAddress mAddress = 0;
};

/// Whether static structures are compacted: about half of the size for the build, according to
/// NVIDIA and AMD.
enum class Compaction : uint8_t { None, Done };

/// One BLAS a mesh, in few buffers, built together and waited for: load time only. A mesh whose
/// geometries hold no triangle gets an empty structure (false). Compacted on GPUs; on software
/// devices a copy costs time and saves nothing.
[[nodiscard]] std::vector<AccelerationStructure>
buildBlas(Device& device, std::span<const std::vector<TriangleGeometry>> meshes);
[[nodiscard]] std::vector<AccelerationStructure> buildBlas(
    Device& device, std::span<const std::vector<TriangleGeometry>> meshes, Compaction compaction
);

/// An instance of a BLAS.
struct Instance {
    float worldFromObject[3][4]; ///< row-major, rows x y z
    uint32_t customIndex = 0;    ///< < 2^24
    bool cullDisabled = true;    ///< double sided
    bool flipFacing = false;     ///< front faces run clockwise: their vertices were mirrored
    uint32_t mask = 0xFF;        ///< rays whose cull mask shares a bit meet it
    VkDeviceAddress blas = 0;

    bool operator==(const Instance&) const = default;
};

/// One TLAS an instance, likewise.
[[nodiscard]] std::vector<AccelerationStructure>
buildTlas(Device& device, std::span<const Instance> instances);

/// An axis-aligned box; finite, min at or below max.
struct BoxGeometry {
    float min[3];
    float max[3];
};

/// A BLAS of boxes with shader-defined intersection, rebuilt when they moved. A box's index is its
/// primitive index. Reuses its buffers and grows them.
class BoxBlas {
  public:
    /// Writes the boxes, at least one, and (re)creates buffers; call before record(). The GPU must
    /// have finished with the last build's boxes.
    void prepare(Device& device, std::span<const BoxGeometry> boxes);
    /// Records the build; the caller places barriers.
    void record(const Device& device, VkCommandBuffer commands);

    [[nodiscard]] const AccelerationStructure& structure() const { return mStructure; }

  private:
    Buffer mBoxes;
    Buffer mScratch;
    AccelerationStructure mStructure;
    uint32_t mCapacity = 0;
    uint32_t mCount = 0;
};

/// A TLAS that is rebuilt when its instances moved. Reuses its buffers and grows them.
class Tlas {
  public:
    /// Writes the instances and (re)creates buffers; call before record(). The GPU must have
    /// finished with the last build's instances (one Tlas per frame in flight).
    void prepare(Device& device, std::span<const Instance> instances);
    /// Records the build. The caller places barriers (build reads and writes
    /// ACCELERATION_STRUCTURE_BUILD).
    void record(const Device& device, VkCommandBuffer commands) const;

    [[nodiscard]] const AccelerationStructure& structure() const { return mStructure; }

  private:
    Buffer mInstances;
    Buffer mScratch;
    AccelerationStructure mStructure;
    uint32_t mCapacity = 0;
    uint32_t mCount = 0;
};

// Shared by the builds here and in structure_set.h (acceleration_build.cpp).

/// Required of a structure in its buffer (VkAccelerationStructureCreateInfoKHR::offset).
inline constexpr VkDeviceSize kStructureAlignment = 256;

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
/// Large enough for alignScratch() to align its address.
[[nodiscard]] Buffer makeScratch(Device& device, const char* name, VkDeviceSize bytes);
[[nodiscard]] VkDeviceAddress alignScratch(const Device& device, const Buffer& scratch);

} // namespace shutter::gpu
