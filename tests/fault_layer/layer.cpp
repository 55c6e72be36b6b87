// SPDX-License-Identifier: MIT
// Where the loader enters, and the tables of what lies below.
#include "tests/fault_layer/dispatch.h"
#include "tests/fault_layer/fault_plan.h"

#include <array>
#include <atomic>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>

namespace shutter::faults {

namespace {

std::mutex sMutex;
std::map<const void*, std::unique_ptr<InstanceTable>> sInstances;
std::map<const void*, std::unique_ptr<DeviceTable>> sDevices;

/// The loader keeps its own table in a handle's first word: the same for all handles of a chain.
const void* keyOf(const void* handle) {
    return *static_cast<const void* const*>(handle);
}

} // namespace

#define SHUTTER_LOAD(name)                                                                         \
    table->name = reinterpret_cast<PFN_vk##name>(getProcAddr(handle, "vk" #name));

InstanceTable& addInstance(VkInstance handle, PFN_vkGetInstanceProcAddr getProcAddr) {
    auto table = std::make_unique<InstanceTable>();
    table->instance = handle;
    table->getProcAddr = getProcAddr;
    SHUTTER_NEXT_OF_INSTANCE(SHUTTER_LOAD)
    const std::lock_guard lock(sMutex);
    return *(sInstances[keyOf(handle)] = std::move(table));
}

DeviceTable& addDevice(VkDevice handle, PFN_vkGetDeviceProcAddr getProcAddr) {
    auto table = std::make_unique<DeviceTable>();
    table->device = handle;
    table->getProcAddr = getProcAddr;
    SHUTTER_NEXT_OF_DEVICE(SHUTTER_LOAD)
    SHUTTER_CREATIONS(SHUTTER_LOAD)
    const std::lock_guard lock(sMutex);
    return *(sDevices[keyOf(handle)] = std::move(table));
}

#undef SHUTTER_LOAD

InstanceTable& findInstance(const void* handle) {
    const std::lock_guard lock(sMutex);
    const auto found = sInstances.find(keyOf(handle));
    if (found == sInstances.end())
        refuse("a call of an unknown instance");
    return *found->second;
}

DeviceTable& findDevice(const void* handle) {
    const std::lock_guard lock(sMutex);
    const auto found = sDevices.find(keyOf(handle));
    if (found == sDevices.end())
        refuse("a call of an unknown device");
    return *found->second;
}

namespace {

// Counts of the process, which may fail before it has anything to count them in.
std::atomic<uint32_t> sInstanceCount = 0;
std::atomic<uint32_t> sDeviceCount = 0;

VKAPI_ATTR VkResult VKAPI_CALL createInstance(
    const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator, VkInstance* instance
) {
    const PFN_vkGetInstanceProcAddr getProcAddr = test::takeLink(*info);
    if (!getProcAddr)
        return VK_ERROR_INITIALIZATION_FAILED;
    FaultPlan::reread();
    if (FaultPlan::get().failsCreation("CreateInstance", ++sInstanceCount))
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    const auto create =
        reinterpret_cast<PFN_vkCreateInstance>(getProcAddr(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    if (result == VK_SUCCESS)
        addInstance(*instance, getProcAddr);
    return result;
}

/// What the program enabled the device to check.
void noteBounds(const VkDeviceCreateInfo& info, DeviceTable& table) {
    for (auto* next = static_cast<const VkBaseInStructure*>(info.pNext); next; next = next->pNext) {
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2)
            table.checksBuffers = reinterpret_cast<const VkPhysicalDeviceFeatures2*>(next)
                                      ->features.robustBufferAccess == VK_TRUE;
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT) {
            const auto* robust =
                reinterpret_cast<const VkPhysicalDeviceRobustness2FeaturesEXT*>(next);
            table.checksBounds = robust->robustBufferAccess2 && robust->robustImageAccess2;
        }
    }
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(
    VkPhysicalDevice physical,
    const VkDeviceCreateInfo* info,
    const VkAllocationCallbacks* allocator,
    VkDevice* device
) {
    const test::DeviceLink below = test::takeLink(*info);
    if (!below.ofDevice)
        return VK_ERROR_INITIALIZATION_FAILED;
    if (FaultPlan::get().failsCreation("CreateDevice", ++sDeviceCount))
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(
        below.ofInstance(findInstance(physical).instance, "vkCreateDevice")
    );
    const VkResult result = FaultPlan::get().statisticsFolder.empty()
                                ? create(physical, info, allocator, device)
                                : createMeasured(create, physical, *info, allocator, device);
    if (result == VK_SUCCESS)
        noteBounds(*info, addDevice(*device, below.ofDevice));
    return result;
}

/// What a test needs to know to fail each call in turn.
void writeCounts(const DeviceTable& table) {
    const std::string& path = FaultPlan::get().countsFile;
    if (path.empty())
        return;
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (!file)
        refuse("cannot write '" + path + "'");
    std::fprintf(
        file,
        "{\"allocations\": %u, \"submissions\": %u, \"acquisitions\": %u, "
        "\"lateAcquisitions\": %u, \"presentations\": %u",
        table.allocationCount.load(),
        table.submissionCount.load(),
        table.acquisitionCount.load(),
        table.lateAcquisitionCount.load(),
        table.presentationCount.load()
    );
    const auto names = listCreationNames();
    std::fprintf(
        file,
        ", \"creations\": {\"CreateInstance\": %u, \"CreateDevice\": %u, "
        "\"CreateSwapchainKHR\": %u",
        sInstanceCount.load(),
        sDeviceCount.load(),
        table.swapchainCount.load()
    );
    for (size_t i = 0; i < names.size(); ++i)
        std::fprintf(file, ", \"%s\": %u", names[i], table.creationCounts[i].load());
    const auto wordOf = [](bool value) { return value ? "true" : "false"; };
    std::fprintf(
        file,
        "}, \"checksBuffers\": %s, \"checksBounds\": %s}\n",
        wordOf(table.checksBuffers),
        wordOf(table.checksBounds)
    );
    std::fclose(file);
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* allocator) {
    if (device == VK_NULL_HANDLE)
        return;
    DeviceTable& table = findDevice(device);
    writeCounts(table);
    table.DestroyDevice(device, allocator);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name);

PFN_vkVoidFunction findOfDevice(const char* name) {
    static const std::array sOwn{
        SHUTTER_ENTRY(GetDeviceProcAddr, getDeviceProcAddr),
        SHUTTER_ENTRY(DestroyDevice, destroyDevice),
    };
    for (const auto entries :
         {std::span<const test::LayerEntry>(sOwn),
          listStatistics(), // in place of others
          listMemoryFaults(),
          listCreations(),
          listQueueFaults()})
        if (const PFN_vkVoidFunction found = test::findEntry(entries, name))
            return found;
    return nullptr;
}

PFN_vkVoidFunction findOfInstance(const char* name) {
    static const std::array sOwn{
        SHUTTER_ENTRY(GetInstanceProcAddr, getInstanceProcAddr),
        SHUTTER_ENTRY(CreateInstance, createInstance),
        SHUTTER_ENTRY(CreateDevice, createDevice),
    };
    const PFN_vkVoidFunction own = test::findEntry(sOwn, name);
    return own ? own : test::findEntry(listReports(), name);
}

PFN_vkVoidFunction getDeviceProcAddr(VkDevice device, const char* name) {
    return test::standIn(findDevice(device).getProcAddr(device, name), findOfDevice(name));
}

PFN_vkVoidFunction getInstanceProcAddr(VkInstance instance, const char* name) {
    if (const PFN_vkVoidFunction own = findOfInstance(name))
        return own;
    if (instance == VK_NULL_HANDLE)
        return nullptr;
    return test::standIn(findInstance(instance).getProcAddr(instance, name), findOfDevice(name));
}

} // namespace

} // namespace shutter::faults

SHUTTER_LAYER(shutter::faults::getInstanceProcAddr, shutter::faults::getDeviceProcAddr)
