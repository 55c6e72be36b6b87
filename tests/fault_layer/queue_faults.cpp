// SPDX-License-Identifier: MIT
// Submissions that lose the device, and windows that change and go away.
#include "tests/fault_layer/dispatch.h"
#include "tests/fault_layer/fault_plan.h"

#include <array>
#include <sys/resource.h>

namespace shutter::faults {

namespace {

/// Nothing runs any more once a device is lost, so earlier submissions complete first: callers may
/// destroy everything after the loss.
VkResult answerLost(const DeviceTable& table) {
    table.DeviceWaitIdle(table.device);
    return VK_ERROR_DEVICE_LOST;
}

/// Replaces a function of a device or queue that reports the loss.
template <auto next> struct UnlessLost;

template <class Handle, class... Args, VkResult (VKAPI_PTR* DeviceTable::*next)(Handle, Args...)>
struct UnlessLost<next> {
    static VKAPI_ATTR VkResult VKAPI_CALL call(Handle handle, Args... args) {
        const DeviceTable& table = findDevice(handle);
        return table.isLost ? answerLost(table) : (table.*next)(handle, args...);
    }
};

/// From here on a file that grows too large is a full disk to programs that ignore SIGXFSZ, and
/// death in the middle of a write to others. Not from the start: drivers have files in memory.
void limitFiles() {
    const rlim_t bytes = FaultPlan::get().fileBytes;
    const rlimit limit{bytes, bytes};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0)
        refuse("cannot limit the size of files");
}

VKAPI_ATTR VkResult VKAPI_CALL
waitSemaphores(VkDevice device, const VkSemaphoreWaitInfo* info, uint64_t timeout) {
    const DeviceTable& table = findDevice(device);
    if (table.isLost)
        return answerLost(table);
    const VkResult result = table.WaitSemaphores(device, info, timeout);
    const uint32_t last = FaultPlan::get().lastBeforeFiles;
    if (last != 0 && table.submissionCount >= last)
        limitFiles();
    return result;
}

template <auto next> struct Submit;

template <class... Args, VkResult (VKAPI_PTR* DeviceTable::*next)(VkQueue, Args...)>
struct Submit<next> {
    static VKAPI_ATTR VkResult VKAPI_CALL call(VkQueue queue, Args... args) {
        const FaultPlan& plan = FaultPlan::get();
        DeviceTable& table = findDevice(queue);
        const uint32_t submission = ++table.submissionCount;
        if (submission == plan.lostSubmission)
            table.isLost = true;
        if (table.isLost)
            return answerLost(table);
        const VkResult result = (table.*next)(queue, args...);
        if (submission == plan.lostExecution)
            table.isLost = true;
        return result;
    }
};

VKAPI_ATTR VkResult VKAPI_CALL acquireNextImage(
    VkDevice device,
    VkSwapchainKHR swapchain,
    uint64_t timeout,
    VkSemaphore semaphore,
    VkFence fence,
    uint32_t* index
) {
    DeviceTable& table = findDevice(device);
    const auto& planned = FaultPlan::get().acquisitions;
    const auto found = planned.find(++table.acquisitionCount);
    if (table.recordingCount > 0)
        ++table.lateAcquisitionCount;
    if (table.isLost)
        return VK_ERROR_DEVICE_LOST;
    // An error acquires nothing and leaves the semaphore alone.
    if (found != planned.end() && found->second < 0)
        return found->second;
    const VkResult result =
        table.AcquireNextImageKHR(device, swapchain, timeout, semaphore, fence, index);
    return result == VK_SUCCESS && found != planned.end() ? found->second : result;
}

VKAPI_ATTR VkResult VKAPI_CALL
beginCommandBuffer(VkCommandBuffer commands, const VkCommandBufferBeginInfo* info) {
    DeviceTable& table = findDevice(commands);
    ++table.recordingCount;
    return table.BeginCommandBuffer(commands, info);
}

VKAPI_ATTR VkResult VKAPI_CALL endCommandBuffer(VkCommandBuffer commands) {
    DeviceTable& table = findDevice(commands);
    --table.recordingCount;
    return table.EndCommandBuffer(commands);
}

VKAPI_ATTR VkResult VKAPI_CALL createSwapchain(
    VkDevice device,
    const VkSwapchainCreateInfoKHR* info,
    const VkAllocationCallbacks* allocator,
    VkSwapchainKHR* swapchain
) {
    DeviceTable& table = findDevice(device);
    const uint32_t number = ++table.swapchainCount;
    if (FaultPlan::get().failsCreation("CreateSwapchainKHR", number))
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    const auto& planned = FaultPlan::get().swapchains;
    const auto found = planned.find(number);
    if (found != planned.end())
        return found->second;
    return table.CreateSwapchainKHR(device, info, allocator, swapchain);
}

VKAPI_ATTR VkResult VKAPI_CALL queuePresent(VkQueue queue, const VkPresentInfoKHR* info) {
    DeviceTable& table = findDevice(queue);
    const auto& planned = FaultPlan::get().presentations;
    const auto found = planned.find(++table.presentationCount);
    if (table.isLost)
        return VK_ERROR_DEVICE_LOST;
    // These answers wait for the semaphores as success does, and give the image back.
    const VkResult result = table.QueuePresentKHR(queue, info);
    return result == VK_SUCCESS && found != planned.end() ? found->second : result;
}

} // namespace

std::span<const test::LayerEntry> listQueueFaults() {
#define SHUTTER_UNLESS_LOST(name) SHUTTER_ENTRY(name, UnlessLost<&DeviceTable::name>::call)
    static const std::array sEntries{
        SHUTTER_ENTRY(QueueSubmit, Submit<&DeviceTable::QueueSubmit>::call),
        SHUTTER_ENTRY(QueueSubmit2, Submit<&DeviceTable::QueueSubmit2>::call),
        SHUTTER_UNLESS_LOST(DeviceWaitIdle),
        SHUTTER_UNLESS_LOST(GetFenceStatus),
        SHUTTER_UNLESS_LOST(GetQueryPoolResults),
        SHUTTER_UNLESS_LOST(GetSemaphoreCounterValue),
        SHUTTER_UNLESS_LOST(QueueWaitIdle),
        SHUTTER_UNLESS_LOST(WaitForFences),
        SHUTTER_ENTRY(WaitSemaphores, waitSemaphores),
        SHUTTER_ENTRY(AcquireNextImageKHR, acquireNextImage),
        SHUTTER_ENTRY(BeginCommandBuffer, beginCommandBuffer),
        SHUTTER_ENTRY(CreateSwapchainKHR, createSwapchain),
        SHUTTER_ENTRY(EndCommandBuffer, endCommandBuffer),
        SHUTTER_ENTRY(QueuePresentKHR, queuePresent),
    };
#undef SHUTTER_UNLESS_LOST
    return sEntries;
}

} // namespace shutter::faults
