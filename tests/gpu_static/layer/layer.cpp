// SPDX-License-Identifier: MIT
// Where the loader enters.
#include "tests/gpu_static/layer/layer.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace shutter::gpu_static {

namespace {

Next sNext;

/// The loader's own part of a chain.
template <class Info> Info* findLink(const void* chain, VkStructureType type) {
    for (auto* info = static_cast<const Info*>(chain); info;
         info = static_cast<const Info*>(info->pNext))
        if (info->sType == type && info->function == VK_LAYER_LINK_INFO)
            return const_cast<Info*>(info);
    return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(
    const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator, VkInstance* instance
) {
    auto* link = findLink<VkLayerInstanceCreateInfo>(
        info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO
    );
    if (!link)
        return VK_ERROR_INITIALIZATION_FAILED;
    const auto getProcAddr = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext; // the next layer looks for its own
    const auto create =
        reinterpret_cast<PFN_vkCreateInstance>(getProcAddr(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    if (result == VK_SUCCESS) {
        sNext.instance = *instance;
        sNext.getInstanceProcAddr = getProcAddr;
    }
    return result;
}

/// Creates the device with the extension that tells what the compiler made of a pipeline.
VKAPI_ATTR VkResult VKAPI_CALL createDevice(
    VkPhysicalDevice physical,
    const VkDeviceCreateInfo* info,
    const VkAllocationCallbacks* allocator,
    VkDevice* device
) {
    auto* link =
        findLink<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (!link)
        return VK_ERROR_INITIALIZATION_FAILED;
    const auto ofInstance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const auto getProcAddr = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;

    std::vector<const char*> extensions(
        info->ppEnabledExtensionNames, info->ppEnabledExtensionNames + info->enabledExtensionCount
    );
    extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR};
    statistics.pNext = const_cast<void*>(info->pNext);
    statistics.pipelineExecutableInfo = VK_TRUE;
    VkDeviceCreateInfo extended = *info;
    extended.pNext = &statistics;
    extended.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    extended.ppEnabledExtensionNames = extensions.data();

    const auto create =
        reinterpret_cast<PFN_vkCreateDevice>(ofInstance(sNext.instance, "vkCreateDevice"));
    const VkResult result = create(physical, &extended, allocator, device);
    if (result != VK_SUCCESS)
        return result;
    sNext.device = *device;
    sNext.getDeviceProcAddr = getProcAddr;
#define SHUTTER_LOAD(name)                                                                         \
    sNext.name = reinterpret_cast<PFN_vk##name>(getProcAddr(*device, "vk" #name));
    SHUTTER_NEXT_OF_DEVICE(SHUTTER_LOAD)
#undef SHUTTER_LOAD
    return result;
}

PFN_vkVoidFunction findEntry(std::span<const Entry> entries, const char* name) {
    for (const Entry& entry : entries)
        if (std::strcmp(entry.name, name) == 0)
            return entry.function;
    return nullptr;
}

PFN_vkVoidFunction findOfDevice(const char* name) {
    const PFN_vkVoidFunction pipelines = findEntry(listPipelines(), name);
    return pipelines ? pipelines : findEntry(listSubmissions(), name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
    const PFN_vkVoidFunction below = sNext.getDeviceProcAddr(device, name);
    const PFN_vkVoidFunction own = findOfDevice(name);
    return below && own ? own : below; // what the device lacks stays missing
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL
getInstanceProcAddr(VkInstance instance, const char* name) {
    static const std::array sOwn{
        SHUTTER_ENTRY(GetInstanceProcAddr, getInstanceProcAddr),
        SHUTTER_ENTRY(GetDeviceProcAddr, getDeviceProcAddr),
        SHUTTER_ENTRY(CreateInstance, createInstance),
        SHUTTER_ENTRY(CreateDevice, createDevice),
    };
    if (const PFN_vkVoidFunction own = findEntry(sOwn, name))
        return own;
    if (instance == VK_NULL_HANDLE)
        return nullptr;
    const PFN_vkVoidFunction below = sNext.getInstanceProcAddr(instance, name);
    const PFN_vkVoidFunction own = findOfDevice(name);
    return below && own ? own : below;
}

} // namespace

const Next& next() {
    return sNext;
}

} // namespace shutter::gpu_static

// VK_LAYER_EXPORT is gone from newer headers.
extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
    version->loaderLayerInterfaceVersion = CURRENT_LOADER_LAYER_INTERFACE_VERSION;
    version->pfnGetInstanceProcAddr = shutter::gpu_static::getInstanceProcAddr;
    version->pfnGetDeviceProcAddr = shutter::gpu_static::getDeviceProcAddr;
    version->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
