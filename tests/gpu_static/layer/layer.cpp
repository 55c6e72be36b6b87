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

VKAPI_ATTR VkResult VKAPI_CALL createInstance(
    const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator, VkInstance* instance
) {
    const PFN_vkGetInstanceProcAddr getProcAddr = test::takeLink(*info);
    if (!getProcAddr)
        return VK_ERROR_INITIALIZATION_FAILED;
    const auto create =
        reinterpret_cast<PFN_vkCreateInstance>(getProcAddr(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    if (result == VK_SUCCESS) {
        sNext.instance = *instance;
        sNext.getInstanceProcAddr = getProcAddr;
    }
    return result;
}

/// Creates the device with the extension that returns a pipeline's compiler statistics.
VKAPI_ATTR VkResult VKAPI_CALL createDevice(
    VkPhysicalDevice physical,
    const VkDeviceCreateInfo* info,
    const VkAllocationCallbacks* allocator,
    VkDevice* device
) {
    const test::DeviceLink below = test::takeLink(*info);
    if (!below.ofDevice)
        return VK_ERROR_INITIALIZATION_FAILED;

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
        reinterpret_cast<PFN_vkCreateDevice>(below.ofInstance(sNext.instance, "vkCreateDevice"));
    const VkResult result = create(physical, &extended, allocator, device);
    if (result != VK_SUCCESS)
        return result;
    sNext.device = *device;
    sNext.getDeviceProcAddr = below.ofDevice;
#define SHUTTER_LOAD(name)                                                                         \
    sNext.name = reinterpret_cast<PFN_vk##name>(below.ofDevice(*device, "vk" #name));
    SHUTTER_NEXT_OF_DEVICE(SHUTTER_LOAD)
#undef SHUTTER_LOAD
    return result;
}

PFN_vkVoidFunction findOfDevice(const char* name) {
    const PFN_vkVoidFunction pipelines = test::findEntry(listPipelines(), name);
    return pipelines ? pipelines : test::findEntry(listSubmissions(), name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
    return test::standIn(sNext.getDeviceProcAddr(device, name), findOfDevice(name));
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL
getInstanceProcAddr(VkInstance instance, const char* name) {
    static const std::array sOwn{
        SHUTTER_ENTRY(GetInstanceProcAddr, getInstanceProcAddr),
        SHUTTER_ENTRY(GetDeviceProcAddr, getDeviceProcAddr),
        SHUTTER_ENTRY(CreateInstance, createInstance),
        SHUTTER_ENTRY(CreateDevice, createDevice),
    };
    if (const PFN_vkVoidFunction own = test::findEntry(sOwn, name))
        return own;
    if (instance == VK_NULL_HANDLE)
        return nullptr;
    return test::standIn(sNext.getInstanceProcAddr(instance, name), findOfDevice(name));
}

} // namespace

const Next& next() {
    return sNext;
}

} // namespace shutter::gpu_static

SHUTTER_LAYER(shutter::gpu_static::getInstanceProcAddr, shutter::gpu_static::getDeviceProcAddr)
