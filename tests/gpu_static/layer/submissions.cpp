// SPDX-License-Identifier: MIT
// A device that executes nothing never reaches the end of a submission: here each has ended when it
// is made. The driver sees none of them.
#include "tests/gpu_static/layer/layer.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>

namespace shutter::gpu_static {

namespace {

std::mutex sSubmissionsMutex;
std::map<VkSemaphore, uint64_t> sValues; // of timelines

VKAPI_ATTR VkResult VKAPI_CALL
submit(VkQueue, uint32_t count, const VkSubmitInfo2* infos, VkFence) {
    const std::lock_guard lock(sSubmissionsMutex);
    for (const VkSubmitInfo2& info : std::span(infos, count))
        for (const VkSemaphoreSubmitInfo& signal :
             std::span(info.pSignalSemaphoreInfos, info.signalSemaphoreInfoCount))
            sValues[signal.semaphore] = signal.value;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL wait(VkDevice, const VkSemaphoreWaitInfo*, uint64_t) {
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL readCounter(VkDevice, VkSemaphore semaphore, uint64_t* value) {
    const std::lock_guard lock(sSubmissionsMutex);
    *value = sValues[semaphore];
    return VK_SUCCESS;
}

/// All times are 0, and so are all sizes.
VKAPI_ATTR VkResult VKAPI_CALL readQueries(
    VkDevice,
    VkQueryPool,
    uint32_t,
    uint32_t,
    size_t bytes,
    void* data,
    VkDeviceSize,
    VkQueryResultFlags
) {
    std::memset(data, 0, bytes);
    return VK_SUCCESS;
}

} // namespace

std::span<const test::LayerEntry> listSubmissions() {
    static const std::array sEntries{
        SHUTTER_ENTRY(QueueSubmit2, submit),
        SHUTTER_ENTRY(WaitSemaphores, wait),
        SHUTTER_ENTRY(GetSemaphoreCounterValue, readCounter),
        SHUTTER_ENTRY(GetQueryPoolResults, readQueries),
    };
    return sEntries;
}

} // namespace shutter::gpu_static
