// SPDX-License-Identifier: MIT
// Vulkan's functions, loaded at run time: without Vulkan, the program can report that in a
// sentence, whereas a program linked to the loader would not start.
//
// Each is a pointer of the name that its prototype has, in the namespace of this project, where
// unqualified names find it before the prototype. Only this tree is built with the pointers
// (SHUTTER_LOADS_VULKAN); a host includes the same headers and uses its own Vulkan.
#pragma once

#include "engine/core/result.h"

#include <vulkan/vulkan.h>

// Those of extensions that need not be there are in ExtensionFunctions (device.h).
#define SHUTTER_VULKAN_FUNCTIONS(X)                                                                \
    X(AcquireNextImageKHR)                                                                         \
    X(AllocateCommandBuffers)                                                                      \
    X(AllocateDescriptorSets)                                                                      \
    X(AllocateMemory)                                                                              \
    X(BeginCommandBuffer)                                                                          \
    X(BindBufferMemory)                                                                            \
    X(BindImageMemory)                                                                             \
    X(CmdBeginRendering)                                                                           \
    X(CmdBindDescriptorSets)                                                                       \
    X(CmdBindIndexBuffer)                                                                          \
    X(CmdBindPipeline)                                                                             \
    X(CmdBlitImage)                                                                                \
    X(CmdClearColorImage)                                                                          \
    X(CmdCopyBuffer)                                                                               \
    X(CmdCopyBufferToImage)                                                                        \
    X(CmdCopyImage)                                                                                \
    X(CmdCopyImageToBuffer)                                                                        \
    X(CmdDispatch)                                                                                 \
    X(CmdDispatchIndirect)                                                                         \
    X(CmdDraw)                                                                                     \
    X(CmdDrawIndexed)                                                                              \
    X(CmdEndRendering)                                                                             \
    X(CmdFillBuffer)                                                                               \
    X(CmdPipelineBarrier2)                                                                         \
    X(CmdPushConstants)                                                                            \
    X(CmdResetQueryPool)                                                                           \
    X(CmdSetCullMode)                                                                              \
    X(CmdSetFrontFace)                                                                             \
    X(CmdSetScissor)                                                                               \
    X(CmdSetViewport)                                                                              \
    X(CmdUpdateBuffer)                                                                             \
    X(CmdWriteTimestamp2)                                                                          \
    X(CreateBuffer)                                                                                \
    X(CreateCommandPool)                                                                           \
    X(CreateComputePipelines)                                                                      \
    X(CreateDescriptorPool)                                                                        \
    X(CreateDescriptorSetLayout)                                                                   \
    X(CreateDevice)                                                                                \
    X(CreateGraphicsPipelines)                                                                     \
    X(CreateImage)                                                                                 \
    X(CreateImageView)                                                                             \
    X(CreateInstance)                                                                              \
    X(CreatePipelineCache)                                                                         \
    X(CreatePipelineLayout)                                                                        \
    X(CreateQueryPool)                                                                             \
    X(CreateSampler)                                                                               \
    X(CreateSemaphore)                                                                             \
    X(CreateShaderModule)                                                                          \
    X(CreateSwapchainKHR)                                                                          \
    X(DestroyBuffer)                                                                               \
    X(DestroyCommandPool)                                                                          \
    X(DestroyDescriptorPool)                                                                       \
    X(DestroyDescriptorSetLayout)                                                                  \
    X(DestroyDevice)                                                                               \
    X(DestroyImage)                                                                                \
    X(DestroyImageView)                                                                            \
    X(DestroyInstance)                                                                             \
    X(DestroyPipeline)                                                                             \
    X(DestroyPipelineCache)                                                                        \
    X(DestroyPipelineLayout)                                                                       \
    X(DestroyQueryPool)                                                                            \
    X(DestroySampler)                                                                              \
    X(DestroySemaphore)                                                                            \
    X(DestroyShaderModule)                                                                         \
    X(DestroySurfaceKHR)                                                                           \
    X(DestroySwapchainKHR)                                                                         \
    X(DeviceWaitIdle)                                                                              \
    X(EndCommandBuffer)                                                                            \
    X(EnumerateDeviceExtensionProperties)                                                          \
    X(EnumerateInstanceExtensionProperties)                                                        \
    X(EnumerateInstanceLayerProperties)                                                            \
    X(EnumeratePhysicalDevices)                                                                    \
    X(FlushMappedMemoryRanges)                                                                     \
    X(FreeMemory)                                                                                  \
    X(GetBufferDeviceAddress)                                                                      \
    X(GetBufferMemoryRequirements)                                                                 \
    X(GetDeviceProcAddr)                                                                           \
    X(GetDeviceQueue)                                                                              \
    X(GetImageMemoryRequirements)                                                                  \
    X(GetInstanceProcAddr)                                                                         \
    X(GetPhysicalDeviceFeatures2)                                                                  \
    X(GetPhysicalDeviceFormatProperties)                                                           \
    X(GetPhysicalDeviceImageFormatProperties)                                                      \
    X(GetPhysicalDeviceMemoryProperties)                                                           \
    X(GetPhysicalDeviceProperties)                                                                 \
    X(GetPhysicalDeviceProperties2)                                                                \
    X(GetPhysicalDeviceQueueFamilyProperties)                                                      \
    X(GetPhysicalDeviceSurfaceCapabilitiesKHR)                                                     \
    X(GetPhysicalDeviceSurfaceFormatsKHR)                                                          \
    X(GetPhysicalDeviceSurfacePresentModesKHR)                                                     \
    X(GetPhysicalDeviceSurfaceSupportKHR)                                                          \
    X(GetPipelineCacheData)                                                                        \
    X(GetQueryPoolResults)                                                                         \
    X(GetSemaphoreCounterValue)                                                                    \
    X(GetSwapchainImagesKHR)                                                                       \
    X(InvalidateMappedMemoryRanges)                                                                \
    X(MapMemory)                                                                                   \
    X(QueuePresentKHR)                                                                             \
    X(QueueSubmit2)                                                                                \
    X(ResetCommandPool)                                                                            \
    X(ResetDescriptorPool)                                                                         \
    X(ResetQueryPool)                                                                              \
    X(UpdateDescriptorSets)                                                                        \
    X(WaitSemaphores)

#ifdef SHUTTER_LOADS_VULKAN
namespace shutter {
#define SHUTTER_DECLARE(name) extern PFN_vk##name vk##name;
SHUTTER_VULKAN_FUNCTIONS(SHUTTER_DECLARE)
#undef SHUTTER_DECLARE
} // namespace shutter
#endif

namespace shutter::gpu {

/// Loads all of them; must be called before any other Vulkan function. Later calls do nothing.
/// Error: the loader is missing, or too old.
[[nodiscard]] core::Status loadVulkan();

} // namespace shutter::gpu
