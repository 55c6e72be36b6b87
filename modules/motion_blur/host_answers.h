// SPDX-License-Identifier: MIT
// Data that a host computes for the effect (by rays, shading or another picture of its own): the
// background behind masked pixels, and samples at instants that no raster holds. The effect writes
// a list of requests, the host records commands that serve them. Also the host's drawing over the
// blurred picture.
#pragma once

#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/c_interface/shutter_motion_blur.h"

#include <functional>

namespace shutter::motion_blur {

using RevealTask = ShutterBlurRevealTask;
using SampleTask = ShutterBlurSampleTask;
using BlendedTask = ShutterBlurBlendedTask;

/// The host's commands, outside of rendering; they may bind anything.
template <class Task> struct HostAnswer {
    /// Records them. Called once within a recording. It must not throw.
    std::function<void(const Task&)> record;
    bool byRayPipeline = false; ///< they launch a ray-tracing pipeline, not compute shaders
};

struct HostReveal : HostAnswer<RevealTask> {};

struct HostSamples : HostAnswer<SampleTask> {};

/// The host's drawing over the blurred picture; fields as in ShutterBlurInputs.
struct HostBlended {
    /// Called once for each part of the exposure, in their order. It must not throw.
    std::function<void(const BlendedTask&)> record;
    VkRect2D area{{0, 0}, {0, 0}};
    uint32_t instantCount = 0;
    uint32_t partCount = 0;
    bool isOpacityInAlpha = false;
};

/// Most that MotionBlurSettings::raysPerPixel may be where a host answers: memory is proportional
/// to it.
inline constexpr float kMaxHostSamplesPerPixel = 16.0f;

/// A task that begins with its size; all else is nothing.
template <class Task> [[nodiscard]] Task makeTask(VkCommandBuffer commands, math::uvec2 sizePx) {
    Task task{};
    task.structBytes = sizeof(Task);
    task.commands = commands;
    task.width = sizePx.x;
    task.height = sizePx.y;
    return task;
}

} // namespace shutter::motion_blur
