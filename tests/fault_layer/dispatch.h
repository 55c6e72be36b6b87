// SPDX-License-Identifier: MIT
// The functions below the layer: of the next layer, or the driver.
#pragma once

#include "tests/support/vulkan_layer.h"

#include <vulkan/vulkan_core.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <set>
#include <span>

namespace shutter::faults {

// Functions of instances and of devices that the layer calls.
#define SHUTTER_NEXT_OF_INSTANCE(X)                                                                \
    X(DestroyInstance)                                                                             \
    X(EnumerateDeviceExtensionProperties)                                                          \
    X(GetPhysicalDeviceFeatures)                                                                   \
    X(GetPhysicalDeviceFeatures2)                                                                  \
    X(GetPhysicalDeviceMemoryProperties)                                                           \
    X(GetPhysicalDeviceMemoryProperties2)                                                          \
    X(GetPhysicalDeviceProperties)                                                                 \
    X(GetPhysicalDeviceProperties2)

#define SHUTTER_NEXT_OF_DEVICE(X)                                                                  \
    X(AcquireNextImageKHR)                                                                         \
    X(AllocateMemory)                                                                              \
    X(BeginCommandBuffer)                                                                          \
    X(CreateSwapchainKHR)                                                                          \
    X(DestroyDevice)                                                                               \
    X(DeviceWaitIdle)                                                                              \
    X(EndCommandBuffer)                                                                            \
    X(FreeMemory)                                                                                  \
    X(GetBufferMemoryRequirements)                                                                 \
    X(GetBufferMemoryRequirements2)                                                                \
    X(GetFenceStatus)                                                                              \
    X(GetImageMemoryRequirements)                                                                  \
    X(GetImageMemoryRequirements2)                                                                 \
    X(GetPipelineExecutablePropertiesKHR)                                                          \
    X(GetPipelineExecutableStatisticsKHR)                                                          \
    X(GetQueryPoolResults)                                                                         \
    X(GetSemaphoreCounterValue)                                                                    \
    X(MapMemory)                                                                                   \
    X(QueuePresentKHR)                                                                             \
    X(QueueSubmit)                                                                                 \
    X(QueueSubmit2)                                                                                \
    X(QueueWaitIdle)                                                                               \
    X(SetDebugUtilsObjectNameEXT)                                                                  \
    X(WaitForFences)                                                                               \
    X(WaitSemaphores)

// Functions of devices that make something.
#define SHUTTER_CREATIONS(X)                                                                       \
    X(AllocateCommandBuffers)                                                                      \
    X(AllocateDescriptorSets)                                                                      \
    X(BindBufferMemory)                                                                            \
    X(BindImageMemory)                                                                             \
    X(CreateAccelerationStructureKHR)                                                              \
    X(CreateBuffer)                                                                                \
    X(CreateCommandPool)                                                                           \
    X(CreateComputePipelines)                                                                      \
    X(CreateDescriptorPool)                                                                        \
    X(CreateDescriptorSetLayout)                                                                   \
    X(CreateGraphicsPipelines)                                                                     \
    X(CreateImage)                                                                                 \
    X(CreateImageView)                                                                             \
    X(CreatePipelineCache)                                                                         \
    X(CreatePipelineLayout)                                                                        \
    X(CreateQueryPool)                                                                             \
    X(CreateRayTracingPipelinesKHR)                                                                \
    X(CreateSampler)                                                                               \
    X(CreateSemaphore)                                                                             \
    X(CreateShaderModule)

/// Kinds of creations that a device counts, or more.
inline constexpr size_t kMaxCreations = 32;

#define SHUTTER_FIELD(name) PFN_vk##name name = nullptr;

struct InstanceTable {
    VkInstance instance = VK_NULL_HANDLE;
    PFN_vkGetInstanceProcAddr getProcAddr = nullptr;
    SHUTTER_NEXT_OF_INSTANCE(SHUTTER_FIELD)
};

struct DeviceTable {
    VkDevice device = VK_NULL_HANDLE;
    PFN_vkGetDeviceProcAddr getProcAddr = nullptr;
    SHUTTER_NEXT_OF_DEVICE(SHUTTER_FIELD)
    SHUTTER_CREATIONS(SHUTTER_FIELD)

    bool checksBuffers = false; ///< the device was made with robustBufferAccess
    bool checksBounds = false;  ///< and with VK_EXT_robustness2
    std::atomic<bool> isLost = false;
    std::atomic<uint32_t> allocationCount = 0;
    std::atomic<uint32_t> livingMemories = 0;
    std::atomic<uint32_t> submissionCount = 0;
    std::array<std::atomic<uint32_t>, kMaxCreations> creationCounts{}; ///< as SHUTTER_CREATIONS
    std::atomic<uint32_t> swapchainCount = 0;
    std::atomic<uint32_t> acquisitionCount = 0;
    std::atomic<uint32_t> recordingCount = 0;       ///< command buffers begun and not ended
    std::atomic<uint32_t> lateAcquisitionCount = 0; ///< while one was recorded
    std::atomic<uint32_t> presentationCount = 0;
    std::mutex hiddenMutex;
    std::set<VkDeviceMemory> hiddenMemory; ///< memory of types that are reported as not visible
    std::mutex heldMutex;
    std::set<uint64_t> heldShaders; ///< modules of FaultPlan::heldPipeline
};

#undef SHUTTER_FIELD

/// Tables live until the process ends; a handle and all that hangs below it share one.
InstanceTable& addInstance(VkInstance instance, PFN_vkGetInstanceProcAddr getProcAddr);
DeviceTable& addDevice(VkDevice device, PFN_vkGetDeviceProcAddr getProcAddr);

/// \param handle an instance, or a physical device of it
[[nodiscard]] InstanceTable& findInstance(const void* handle);
/// \param handle a device, or a queue or command buffer of it
[[nodiscard]] DeviceTable& findDevice(const void* handle);

// The functions that the layer replaces, by their fault.

/// Other limits, features, extensions and types of memory.
[[nodiscard]] std::span<const test::LayerEntry> listReports();

/// Allocations that fail, and memory of the reported types.
[[nodiscard]] std::span<const test::LayerEntry> listMemoryFaults();

/// Objects that cannot be made.
[[nodiscard]] std::span<const test::LayerEntry> listCreations();
/// The functions' names without "vk", in the order of DeviceTable::creationCounts.
[[nodiscard]] std::span<const char* const> listCreationNames();

/// Those replaced in other files.
[[nodiscard]] std::span<const char* const> listOtherCreationNames();

/// Submissions, every function that reports a lost device, and windows.
[[nodiscard]] std::span<const test::LayerEntry> listQueueFaults();

/// Pipelines, whose statistics are written down, and submissions, which end at once; nothing where
/// no folder is set for the statistics.
[[nodiscard]] std::span<const test::LayerEntry> listStatistics();

/// Creates a device that reports a pipeline's statistics.
[[nodiscard]] VkResult createMeasured(
    PFN_vkCreateDevice create,
    VkPhysicalDevice physical,
    const VkDeviceCreateInfo& info,
    const VkAllocationCallbacks* allocator,
    VkDevice* device
);

} // namespace shutter::faults
