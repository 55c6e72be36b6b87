// SPDX-License-Identifier: MIT
// What stands below the layer: the next layer, or the driver.
#pragma once

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan_core.h>

#include <atomic>
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
    X(DestroyDevice)                                                                               \
    X(DeviceWaitIdle)                                                                              \
    X(FreeMemory)                                                                                  \
    X(GetBufferMemoryRequirements)                                                                 \
    X(GetBufferMemoryRequirements2)                                                                \
    X(GetFenceStatus)                                                                              \
    X(GetImageMemoryRequirements)                                                                  \
    X(GetImageMemoryRequirements2)                                                                 \
    X(GetQueryPoolResults)                                                                         \
    X(GetSemaphoreCounterValue)                                                                    \
    X(MapMemory)                                                                                   \
    X(QueuePresentKHR)                                                                             \
    X(QueueSubmit)                                                                                 \
    X(QueueSubmit2)                                                                                \
    X(QueueWaitIdle)                                                                               \
    X(WaitForFences)                                                                               \
    X(WaitSemaphores)

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

    std::atomic<bool> isLost = false;
    std::atomic<uint32_t> allocationCount = 0;
    std::atomic<uint32_t> livingMemories = 0;
    std::atomic<uint32_t> submissionCount = 0;
    std::atomic<uint32_t> acquisitionCount = 0;
    std::atomic<uint32_t> presentationCount = 0;
    std::mutex hiddenMutex;
    std::set<VkDeviceMemory> hiddenMemory; ///< memory of types that are said not to be visible
};

#undef SHUTTER_FIELD

/// Tables live until the process ends; a handle and all that hangs below it share one.
InstanceTable& addInstance(VkInstance instance, PFN_vkGetInstanceProcAddr getProcAddr);
DeviceTable& addDevice(VkDevice device, PFN_vkGetDeviceProcAddr getProcAddr);

/// \param handle an instance, or a physical device of it
[[nodiscard]] InstanceTable& findInstance(const void* handle);
/// \param handle a device, or a queue of it
[[nodiscard]] DeviceTable& findDevice(const void* handle);

/// A function of this layer.
struct Entry {
    const char* name;
    PFN_vkVoidFunction function;
};

#define SHUTTER_ENTRY(name, function)                                                              \
    Entry {                                                                                        \
        "vk" #name, reinterpret_cast<PFN_vkVoidFunction>(static_cast<PFN_vk##name>(function))      \
    }

// The functions that the layer stands in for, by what they fail at.

/// Other limits, features, extensions and types of memory.
[[nodiscard]] std::span<const Entry> listReports();

/// Allocations that fail, and memory of the reported types.
[[nodiscard]] std::span<const Entry> listMemoryFaults();

/// Submissions, and everything that tells of a lost device.
[[nodiscard]] std::span<const Entry> listLostDevice();

/// Windows that change and go away.
[[nodiscard]] std::span<const Entry> listSwapchainFaults();

} // namespace shutter::faults
