// SPDX-License-Identifier: MIT
// What passes that trace rays need of a scene: this engine's renderer fills these structs, and so
// may any other host. Handles belong to one frame.
#pragma once

#include "engine/gpu/vulkan.h"
#include "engine/graph/types.h"

#include <vector>

namespace shutter::graph {

/// The scene at the raster instant.
struct RayScene {
    BufferHandle tlasBuffer; ///< read with Access::AccelerationRead
    /// A second TLAS, of the movers: read with Access::AccelerationRead; invalid: there is none.
    BufferHandle movingTlasBuffer;
    /// BLAS of deformed meshes, read with Access::AccelerationRead, and their vertices, read with
    /// Access::ShaderRead; invalid where nothing is deformed.
    BufferHandle deformedBlasBuffer;
    BufferHandle deformedBuffer;
    std::vector<BufferHandle> shading; ///< that hits are shaded by, read with Access::ShaderRead
    VkAccelerationStructureKHR tlas = VK_NULL_HANDLE; ///< custom index: row of the entity table
    VkDescriptorSet textures = VK_NULL_HANDLE;        ///< set 1 of pipelines: bindless textures
    VkDeviceAddress frameConstants = 0;               ///< shader::FrameConstants
    bool hasBlended = false;                          ///< blended surfaces may be in the picture
};

/// The scene for time-sampled rays in the exposure.
struct TimedRays {
    BufferHandle tlasBuffer;  ///< read with Access::AccelerationRead
    BufferHandle boxesBuffer; ///< read with Access::AccelerationRead; invalid: nothing moves
    /// Vertices of deformed meshes at the raster instant, shutter open and close, from which hits
    /// get their motion: read with Access::ShaderRead; invalid: nothing is deformed.
    BufferHandle deformedBuffer;
    VkAccelerationStructureKHR tlas = VK_NULL_HANDLE;
    VkDescriptorSet textures = VK_NULL_HANDLE;
    VkDeviceAddress frameConstants = 0;
    VkDeviceAddress timedConstants = 0; ///< shader::TimedConstants
};

} // namespace shutter::graph
