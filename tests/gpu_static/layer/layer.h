// SPDX-License-Identifier: MIT
// Functions below the layer, and those that it replaces.
#pragma once

#include "tests/support/vulkan_layer.h"

#include <vulkan/vulkan_core.h>

#include <span>

namespace shutter::gpu_static {

// Functions of the device that the layer calls.
#define SHUTTER_NEXT_OF_DEVICE(X)                                                                  \
    X(CreateComputePipelines)                                                                      \
    X(CreateGraphicsPipelines)                                                                     \
    X(CreateRayTracingPipelinesKHR)                                                                \
    X(CreateShaderModule)                                                                          \
    X(GetPipelineExecutablePropertiesKHR)                                                          \
    X(GetPipelineExecutableStatisticsKHR)                                                          \
    X(SetDebugUtilsObjectNameEXT)

#define SHUTTER_FIELD(name) PFN_vk##name name = nullptr;

/// The program opens one instance and one device at a time.
struct Next {
    VkInstance instance = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    PFN_vkGetDeviceProcAddr getDeviceProcAddr = nullptr;
    SHUTTER_NEXT_OF_DEVICE(SHUTTER_FIELD)
};

#undef SHUTTER_FIELD

[[nodiscard]] const Next& next();

/// Pipelines, of which the compiler's statistics are written down.
[[nodiscard]] std::span<const test::LayerEntry> listPipelines();

/// Submissions, which have ended at once, and all that waits for them.
[[nodiscard]] std::span<const test::LayerEntry> listSubmissions();

} // namespace shutter::gpu_static
