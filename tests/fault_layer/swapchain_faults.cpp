// SPDX-License-Identifier: MIT
#include "tests/fault_layer/dispatch.h"
#include "tests/fault_layer/fault_plan.h"

#include <array>

namespace shutter::faults {

namespace {

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

std::span<const test::LayerEntry> listSwapchainFaults() {
    static const std::array sEntries{
        SHUTTER_ENTRY(AcquireNextImageKHR, acquireNextImage),
        SHUTTER_ENTRY(BeginCommandBuffer, beginCommandBuffer),
        SHUTTER_ENTRY(CreateSwapchainKHR, createSwapchain),
        SHUTTER_ENTRY(EndCommandBuffer, endCommandBuffer),
        SHUTTER_ENTRY(QueuePresentKHR, queuePresent),
    };
    return sEntries;
}

} // namespace shutter::faults
