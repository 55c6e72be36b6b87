// SPDX-License-Identifier: MIT
// The background behind masked pixels by a host's own means: its rays, its shading, or another
// picture that it has. The effect asks for pixels, the host records what answers.
#pragma once

#include "engine/gpu/vulkan.h"

#include <glm/glm.hpp>

#include <functional>

namespace shutter::motion_blur {

struct RevealTarget {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
};

/// What the host's commands read and write. All of it is ready for compute shaders, and for
/// ray-tracing shaders with OwnReveal::byRayPipeline; what is written needs no barrier of the
/// host's. Its images are in VK_IMAGE_LAYOUT_GENERAL. The images of HostInputs that the effect
/// reads may be sampled: they are in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL.
struct RevealTask {
    VkCommandBuffer commands = VK_NULL_HANDLE; ///< those of the recording
    glm::uvec2 sizePx{0u};                     ///< of the picture
    /// How many pixels ask (uint32_t), 12 bytes of other counts, then the pixels: x | y << 16.
    VkBuffer list = VK_NULL_HANDLE;
    VkDeviceAddress listAddress = 0; ///< of `list`
    VkDeviceSize listBytes = 0;      ///< of the whole list, from its beginning
    /// VkDispatchIndirectCommand: groups of 64 threads, at most 256 in x, one thread a pixel.
    /// Thread t of group (x, y) serves pixel (y * 256 + x) * 64 + t, if so many ask.
    VkBuffer groups = VK_NULL_HANDLE;
    /// VkTraceRaysIndirectCommandKHR: one launch a pixel, in x. Null where
    /// HostDevice::tracesIndirect is false.
    VkBuffer launch = VK_NULL_HANDLE;
    VkDeviceAddress launchAddress = 0; ///< of `launch`; 0 where that is null
    // Storage images of the picture's size, to be written at every pixel that asks: what is seen
    // there past the entity in front.
    RevealTarget color;       ///< RGBA16F
    RevealTarget motionDepth; ///< RGBA32F: as HostInputs::motionDepth
    RevealTarget entityId;    ///< R32_UINT; 0xFFFFFFFF: the sky
};

struct OwnReveal {
    /// Records the host's commands, outside of rendering; they may bind anything. Called once
    /// within a recording. It must not throw.
    std::function<void(const RevealTask&)> record;
    /// The commands launch a ray-tracing pipeline, instead of compute shaders.
    bool byRayPipeline = false;
};

} // namespace shutter::motion_blur
