// SPDX-License-Identifier: MIT
// Objects that a device cannot make: images, pipelines, pools and all else but memory.
#include "tests/fault_layer/dispatch.h"
#include "tests/fault_layer/fault_plan.h"

#include <algorithm>
#include <array>
#include <fstream>
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

VKAPI_ATTR VkResult VKAPI_CALL setName(VkDevice device, const VkDebugUtilsObjectNameInfoEXT* info) {
    DeviceTable& table = findDevice(device);
    if (info->objectType == VK_OBJECT_TYPE_SHADER_MODULE) {
        const std::lock_guard lock(table.heldMutex);
        if (info->pObjectName && info->pObjectName == FaultPlan::get().heldPipeline)
            table.heldShaders.insert(info->objectHandle);
        else
            table.heldShaders.erase(info->objectHandle); // of one that is gone
    }
    return table.SetDebugUtilsObjectNameEXT(device, info);
}

void waitIfHeld(DeviceTable& table, std::span<const VkPipelineShaderStageCreateInfo> stages) {
    const auto isHeld = [&](const VkPipelineShaderStageCreateInfo& stage) {
        const std::lock_guard lock(table.heldMutex);
        return table.heldShaders.contains(reinterpret_cast<uint64_t>(stage.module));
    };
    if (std::any_of(stages.begin(), stages.end(), isHeld))
        std::ifstream(FaultPlan::get().heldUntil); // opens once there is a writer
}

/// Only pipelines are held.
void hold(DeviceTable&, const auto&) {}

void hold(DeviceTable& table, const VkComputePipelineCreateInfo* info) {
    waitIfHeld(table, {&info->stage, 1});
}

void hold(DeviceTable& table, const VkRayTracingPipelineCreateInfoKHR* info) {
    waitIfHeld(table, {info->pStages, info->stageCount});
}

/// Replaces a function that creates an object. Any of them may run out of main memory.
template <size_t index, auto next> struct Create;

template <size_t index, class... Args, VkResult (VKAPI_PTR* DeviceTable::*next)(VkDevice, Args...)>
struct Create<index, next> {
    static VKAPI_ATTR VkResult VKAPI_CALL call(VkDevice device, Args... args) {
        DeviceTable& table = findDevice(device);
        const uint32_t number = ++table.creationCounts[index];
        if (FaultPlan::get().failsCreation(kNames[index], number))
            return VK_ERROR_OUT_OF_HOST_MEMORY;
        (hold(table, args), ...);
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

std::span<const test::LayerEntry> listCreations() {
#define SHUTTER_CREATE(name)                                                                       \
    SHUTTER_ENTRY(name, (Create<findIndex(#name), &DeviceTable::name>::call)),
    static const std::array sEntries{SHUTTER_CREATIONS(SHUTTER_CREATE)
                                         SHUTTER_ENTRY(SetDebugUtilsObjectNameEXT, setName)};
#undef SHUTTER_CREATE
    return sEntries;
}

} // namespace shutter::faults
