// SPDX-License-Identifier: MIT
// Helpers for a Vulkan layer between the loader and the next layer. No library: a layer links to
// nothing.
#pragma once

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan_core.h>

#include <cstring>
#include <span>

namespace shutter::test {

/// A function of a layer.
struct LayerEntry {
    const char* name;
    PFN_vkVoidFunction function;
};

#define SHUTTER_ENTRY(name, function)                                                              \
    shutter::test::LayerEntry {                                                                    \
        "vk" #name, reinterpret_cast<PFN_vkVoidFunction>(static_cast<PFN_vk##name>(function))      \
    }

/// \return null: not among them
[[nodiscard]] inline PFN_vkVoidFunction
findEntry(std::span<const LayerEntry> entries, const char* name) {
    for (const LayerEntry& entry : entries)
        if (std::strcmp(entry.name, name) == 0)
            return entry.function;
    return nullptr;
}

/// The loader's own part of a chain.
template <class Info> Info* findLink(const void* chain, VkStructureType type) {
    for (auto* info = static_cast<const Info*>(chain); info;
         info = static_cast<const Info*>(info->pNext))
        if (info->sType == type && info->function == VK_LAYER_LINK_INFO)
            return const_cast<Info*>(info);
    return nullptr;
}

/// The functions below the layer while a device is created.
struct DeviceLink {
    PFN_vkGetInstanceProcAddr ofInstance = nullptr;
    PFN_vkGetDeviceProcAddr ofDevice = nullptr;
};

/// Moves the chain on, so that the next layer finds its own link.
/// \return null: the loader gave none
[[nodiscard]] inline PFN_vkGetInstanceProcAddr takeLink(const VkInstanceCreateInfo& info) {
    auto* link = findLink<VkLayerInstanceCreateInfo>(
        info.pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO
    );
    if (!link)
        return nullptr;
    const PFN_vkGetInstanceProcAddr below = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    return below;
}

/// As above.
/// \return nulls: the loader gave none
[[nodiscard]] inline DeviceLink takeLink(const VkDeviceCreateInfo& info) {
    auto* link =
        findLink<VkLayerDeviceCreateInfo>(info.pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (!link)
        return {};
    const DeviceLink below{
        link->u.pLayerInfo->pfnNextGetInstanceProcAddr,
        link->u.pLayerInfo->pfnNextGetDeviceProcAddr};
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    return below;
}

/// \return the layer's own function, unless it is missing below: then it stays missing
[[nodiscard]] inline PFN_vkVoidFunction standIn(PFN_vkVoidFunction below, PFN_vkVoidFunction own) {
    return below && own ? own : below;
}

} // namespace shutter::test

// Where the loader enters. VK_LAYER_EXPORT is gone from newer headers.
#define SHUTTER_LAYER(getInstanceFunction, getDeviceFunction)                                      \
    extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL               \
    vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {                   \
        version->loaderLayerInterfaceVersion = CURRENT_LOADER_LAYER_INTERFACE_VERSION;             \
        version->pfnGetInstanceProcAddr = getInstanceFunction;                                     \
        version->pfnGetDeviceProcAddr = getDeviceFunction;                                         \
        version->pfnGetPhysicalDeviceProcAddr = nullptr;                                           \
        return VK_SUCCESS;                                                                         \
    }
