// SPDX-License-Identifier: MIT
#include "tests/fault_layer/dispatch.h"

#include "tests/fault_layer/fault_plan.h"

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

} // namespace shutter::faults
