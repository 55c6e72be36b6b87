// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <string>

namespace shutter::graph {

/// A version of an image of one frame. Writing gives a new version; the old one may still be read
/// by passes that the graph can order before the write.
struct ImageHandle {
    uint32_t resource = UINT32_MAX;
    uint32_t version = 0;
    uint32_t graph = 0;     ///< which graph made it, so that last frame's handles are caught
    bool isStencil = false; ///< shaders see the stencil beside the depth (stencilOf())

    [[nodiscard]] bool isValid() const { return resource != UINT32_MAX; }

    bool operator==(const ImageHandle&) const = default;
};

/// The same image, of which passes sample the stencil.
[[nodiscard]] inline ImageHandle stencilOf(ImageHandle image) {
    image.isStencil = true;
    return image;
}

/// The same for a buffer (or an acceleration structure, which is ordered like one).
struct BufferHandle {
    uint32_t resource = UINT32_MAX;
    uint32_t version = 0;
    uint32_t graph = 0; ///< which graph made it, so that last frame's handles are caught

    [[nodiscard]] bool isValid() const { return resource != UINT32_MAX; }

    bool operator==(const BufferHandle&) const = default;
};

/// Size and format of a transient image; how it is used follows from the passes.
struct TransientImageDesc {
    uint32_t width = 1;
    uint32_t height = 1;
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t samples = 1; ///< per pixel; several: drawn into and sampled, nothing else

    bool operator==(const TransientImageDesc&) const = default;
};

struct TransientBufferDesc {
    VkDeviceSize bytes = 0;
    VkBufferUsageFlags usage = 0;

    bool operator==(const TransientBufferDesc&) const = default;
};

/// How an imported image is used before or after the frame, for the barriers at both ends.
struct OutsideUse {
    /// Before: UNDEFINED discards the contents. After: UNDEFINED, any layout.
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkAccessFlags2 access = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
};

/// How a pass touches a resource: what barriers, layouts and usage flags follow from.
enum class Access : uint8_t {
    SampledCompute,  ///< image: texture() in a compute or ray-tracing shader
    SampledFragment, ///< image: texture() in a fragment shader
    StorageRead,     ///< image or buffer: load in a compute or ray-tracing shader
    StorageWrite,    ///< image or buffer: store (and load) in a compute or ray-tracing shader
    /// image: the same, but consecutive passes write disjoint texels: there is no barrier between
    /// them, and they may run concurrently
    StorageWriteDisjoint,
    /// image: written, in the general layout, by commands that are not the pass's own: as storage
    /// image, colour attachment or target of copies
    OutsideWrite,
    ColorAttachment,   ///< image: written as colour attachment
    DepthAttachment,   ///< image: tested and written as depth attachment
    TransferRead,      ///< copy source
    TransferWrite,     ///< copy or clear target
    IndirectRead,      ///< buffer: dispatch, draw or launch arguments
    ShaderRead,        ///< buffer: read in any shader stage
    AccelerationRead,  ///< buffer: traced in a compute or ray-tracing shader
    AccelerationBuild, ///< buffer: built
    HostRead,          ///< buffer: read by the CPU after the frame
};

[[nodiscard]] bool isWrite(Access access);
[[nodiscard]] const char* describe(Access access);

enum class PassKind : uint8_t {
    Compute,
    Raster,
    Transfer,
    Build,      ///< of acceleration structures
    RayTracing, ///< launches of ray-tracing pipelines
};

} // namespace shutter::graph
