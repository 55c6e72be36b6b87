// SPDX-License-Identifier: MIT
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

} // namespace

std::span<const test::LayerEntry> listLostDevice() {
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
    };
#undef SHUTTER_UNLESS_LOST
    return sEntries;
}

} // namespace shutter::faults
