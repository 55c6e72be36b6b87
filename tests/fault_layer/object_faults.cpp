// SPDX-License-Identifier: MIT
// Objects that a device cannot make: images, pipelines, pools, and memory.
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

/// All reported types are one of the device's own: its first, which must fit every use.
constexpr uint32_t kOwnType = 0;

bool isVisible(uint32_t type) {
    return (FaultPlan::get().memoryTypes[type] & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
}

VKAPI_ATTR VkResult VKAPI_CALL allocateMemory(
    VkDevice device,
    const VkMemoryAllocateInfo* info,
    const VkAllocationCallbacks* allocator,
    VkDeviceMemory* memory
) {
    const FaultPlan& plan = FaultPlan::get();
    DeviceTable& table = findDevice(device);
    if (plan.allocations.holds(++table.allocationCount))
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    const auto limit = plan.limits.find("maxMemoryAllocationCount");
    if (limit != plan.limits.end() && table.livingMemories >= limit->second)
        return VK_ERROR_TOO_MANY_OBJECTS;
    VkMemoryAllocateInfo own = *info;
    if (!plan.memoryTypes.empty())
        own.memoryTypeIndex = kOwnType;
    const VkResult result = table.AllocateMemory(device, &own, allocator, memory);
    if (result != VK_SUCCESS)
        return result;
    ++table.livingMemories;
    const std::lock_guard lock(table.hiddenMutex);
    if (!plan.memoryTypes.empty() && !isVisible(info->memoryTypeIndex))
        table.hiddenMemory.insert(*memory);
    return result;
}

VKAPI_ATTR void VKAPI_CALL
freeMemory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* allocator) {
    DeviceTable& table = findDevice(device);
    if (memory != VK_NULL_HANDLE)
        --table.livingMemories;
    {
        const std::lock_guard lock(table.hiddenMutex);
        table.hiddenMemory.erase(memory);
    }
    table.FreeMemory(device, memory, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL mapMemory(
    VkDevice device,
    VkDeviceMemory memory,
    VkDeviceSize offset,
    VkDeviceSize size,
    VkMemoryMapFlags flags,
    void** data
) {
    DeviceTable& table = findDevice(device);
    {
        const std::lock_guard lock(table.hiddenMutex);
        if (table.hiddenMemory.contains(memory))
            return VK_ERROR_MEMORY_MAP_FAILED;
    }
    return table.MapMemory(device, memory, offset, size, flags, data);
}

void reportTypes(VkMemoryRequirements& needs) {
    const size_t count = FaultPlan::get().memoryTypes.size();
    if (count == 0)
        return;
    if ((needs.memoryTypeBits & (1u << kOwnType)) == 0)
        refuse("the device's first type of memory does not fit everything");
    needs.memoryTypeBits = count == 32 ? UINT32_MAX : (1u << count) - 1;
}

/// Replaces a function that returns an object's allowed memory types.
template <auto next> struct QueryNeeds;

template <
    class Object,
    void (VKAPI_PTR* DeviceTable::*next)(VkDevice, Object, VkMemoryRequirements*)>
struct QueryNeeds<next> {
    static VKAPI_ATTR void VKAPI_CALL
    call(VkDevice device, Object object, VkMemoryRequirements* needs) {
        (findDevice(device).*next)(device, object, needs);
        reportTypes(*needs);
    }
};

template <class Info, void (VKAPI_PTR* DeviceTable::*next)(VkDevice, Info, VkMemoryRequirements2*)>
struct QueryNeeds<next> {
    static VKAPI_ATTR void VKAPI_CALL
    call(VkDevice device, Info info, VkMemoryRequirements2* needs) {
        (findDevice(device).*next)(device, info, needs);
        reportTypes(needs->memoryRequirements);
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

std::span<const test::LayerEntry> listMemoryFaults() {
#define SHUTTER_QUERY_NEEDS(name) SHUTTER_ENTRY(name, QueryNeeds<&DeviceTable::name>::call)
    static const std::array sEntries{
        SHUTTER_ENTRY(AllocateMemory, allocateMemory),
        SHUTTER_ENTRY(FreeMemory, freeMemory),
        SHUTTER_ENTRY(MapMemory, mapMemory),
        SHUTTER_QUERY_NEEDS(GetBufferMemoryRequirements),
        SHUTTER_QUERY_NEEDS(GetBufferMemoryRequirements2),
        SHUTTER_QUERY_NEEDS(GetImageMemoryRequirements),
        SHUTTER_QUERY_NEEDS(GetImageMemoryRequirements2),
    };
#undef SHUTTER_QUERY_NEEDS
    return sEntries;
}

} // namespace shutter::faults
