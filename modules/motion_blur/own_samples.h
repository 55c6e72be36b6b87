// SPDX-License-Identifier: MIT
// What a pixel saw at instants that no raster holds, by a host's own means: its rays, its shading.
// The effect asks for samples, the host records what answers.
#pragma once

#include "engine/gpu/vulkan.h"

#include <glm/glm.hpp>

#include <functional>

namespace shutter::motion_blur {

/// What the host's commands read and write. All of it is ready for compute shaders, and for
/// ray-tracing shaders with OwnSamples::byRayPipeline; what is written needs no barrier of the
/// host's.
struct SampleTask {
    VkCommandBuffer commands = VK_NULL_HANDLE; ///< those of the recording
    glm::uvec2 sizePx{0u};                     ///< of the picture
    /// How many samples ask (uint32_t), 12 bytes of other counts, then 8 bytes a sample: its pixel,
    /// x | y << 16 (uint32_t), and its shutter time, 0 open to 1 close (float).
    VkBuffer list = VK_NULL_HANDLE;
    VkDeviceAddress listAddress = 0; ///< of `list`
    VkDeviceSize listBytes = 0;      ///< of the whole list, from its beginning
    /// VkDispatchIndirectCommand: groups of 64 threads, at most 256 in x, one thread a sample.
    /// Thread t of group (x, y) serves sample (y * 256 + x) * 64 + t, if so many ask.
    VkBuffer groups = VK_NULL_HANDLE;
    /// VkTraceRaysIndirectCommandKHR: one launch a sample, in x. Null where
    /// HostDevice::tracesIndirect or byRayPipeline is false.
    VkBuffer launch = VK_NULL_HANDLE;
    VkDeviceAddress launchAddress = 0; ///< of `launch`; 0 where that is null
    /// 16 bytes a sample, to be written: red, green, blue (linear floats) of what is seen through
    /// the pixel's centre by the camera of that time, in the world of that time, and a fourth float
    /// of 1. Samples that are not written stay as they were looked up.
    VkBuffer answers = VK_NULL_HANDLE;
    VkDeviceAddress answersAddress = 0; ///< of `answers`
    VkDeviceSize answersBytes = 0;
};

struct OwnSamples {
    /// Records the host's commands, outside of rendering; they may bind anything. Called once
    /// within a recording. It must not throw.
    std::function<void(const SampleTask&)> record;
    /// The commands launch a ray-tracing pipeline, instead of compute shaders.
    bool byRayPipeline = false;
};

/// Most that MotionBlurSettings::raysPerPixel may be where a host answers: memory is proportional
/// to it.
inline constexpr float kMostOwnSamplesPerPixel = 16.0f;

} // namespace shutter::motion_blur
