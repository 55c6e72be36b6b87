// SPDX-License-Identifier: MIT
// Ray-tracing pipelines with their shader binding tables (VK_KHR_ray_tracing_pipeline).
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"

#include <array>
#include <cstdint>

namespace shutter::gpu {

/// Offsets of the three groups' handles in a shader binding table.
struct BindingTableLayout {
    VkDeviceSize stride = 0;               ///< of a handle, bytes
    std::array<VkDeviceSize, 3> offsets{}; ///< start, miss, hit; from an address that is aligned
    VkDeviceSize bytes = 0;
};

[[nodiscard]] BindingTableLayout computeTableLayout(const ShaderGroupLimits& limits);

/// A pipeline and its shader binding table. The device must have RayTier::Pipeline (CHECKed).
class RayPipeline {
  public:
    RayPipeline(Device& device, const RayPipelineDesc& desc);
    /// \param made of a RayPipelineDesc
    RayPipeline(Device& device, Pipeline made);

    [[nodiscard]] const Pipeline& pipeline() const { return mPipeline; }

    /// Launches one start a cell; pipeline() must be bound.
    void trace(VkCommandBuffer commands, uint32_t width, uint32_t height) const;
    /// Reads a VkTraceRaysIndirectCommandKHR; the device must have DeviceInfo::tracesIndirect.
    void traceIndirect(VkCommandBuffer commands, VkBuffer arguments) const;

  private:
    Device* mDevice;
    Pipeline mPipeline;
    Buffer mTable;
    std::array<VkStridedDeviceAddressRegionKHR, 3> mRegions{}; ///< start, miss, hit
};

} // namespace shutter::gpu
