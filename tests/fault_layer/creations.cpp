// SPDX-License-Identifier: MIT
// Objects that a device cannot make: images, pipelines, pools and all else but memory.
#include "tests/fault_layer/dispatch.h"
#include "tests/fault_layer/fault_plan.h"

#include <array>
#include <string_view>

namespace shutter::faults {

namespace {

#define SHUTTER_COUNT(name) +1
constexpr size_t kCreationCount = 0 SHUTTER_CREATIONS(SHUTTER_COUNT);
#undef SHUTTER_COUNT
static_assert(kCreationCount <= kMaxCreations);

#define SHUTTER_NAME(name) #name,
constexpr std::array kNames{SHUTTER_CREATIONS(SHUTTER_NAME)};
#undef SHUTTER_NAME

constexpr size_t findIndex(std::string_view name) {
    for (size_t i = 0; i < kNames.size(); ++i)
        if (name == kNames[i])
            return i;
    return kNames.size();
}

/// Stands in for a function that makes something. Main memory is what any of them may lack.
template <size_t index, auto next> struct Create;

template <size_t index, class... Args, VkResult (VKAPI_PTR* DeviceTable::*next)(VkDevice, Args...)>
struct Create<index, next> {
    static VKAPI_ATTR VkResult VKAPI_CALL call(VkDevice device, Args... args) {
        DeviceTable& table = findDevice(device);
        const uint32_t number = ++table.creationCounts[index];
        if (FaultPlan::get().failsCreation(kNames[index], number))
            return VK_ERROR_OUT_OF_HOST_MEMORY;
        return (table.*next)(device, args...);
    }
};

} // namespace

std::span<const char* const> listCreationNames() {
    return kNames;
}

std::span<const char* const> listOtherCreationNames() {
    static constexpr std::array kOthers{"CreateInstance", "CreateDevice", "CreateSwapchainKHR"};
    return kOthers;
}

std::span<const Entry> listCreations() {
#define SHUTTER_CREATE(name)                                                                       \
    SHUTTER_ENTRY(name, (Create<findIndex(#name), &DeviceTable::name>::call)),
    static const std::array sEntries{SHUTTER_CREATIONS(SHUTTER_CREATE)};
#undef SHUTTER_CREATE
    return sEntries;
}

} // namespace shutter::faults
