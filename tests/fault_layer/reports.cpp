// SPDX-License-Identifier: MIT
#include "tests/fault_layer/dispatch.h"
#include "tests/fault_layer/fault_plan.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

namespace shutter::faults {

namespace {

struct Limit {
    const char* name;
    uint32_t VkPhysicalDeviceLimits::*value;
};

#define SHUTTER_LIMIT(name)                                                                        \
    Limit {                                                                                        \
#name, &VkPhysicalDeviceLimits::name                                                       \
    }
constexpr std::array kLimits{
    SHUTTER_LIMIT(maxImageDimension2D),
    SHUTTER_LIMIT(maxStorageBufferRange),
    SHUTTER_LIMIT(maxMemoryAllocationCount),
    SHUTTER_LIMIT(maxPerStageDescriptorSamplers),
    SHUTTER_LIMIT(maxPerStageDescriptorSampledImages),
    SHUTTER_LIMIT(standardSampleLocations),
};
#undef SHUTTER_LIMIT

void report(VkPhysicalDeviceProperties& properties) {
    properties.deviceType = FaultPlan::get().kind.value_or(properties.deviceType);
    for (const auto& [name, value] : FaultPlan::get().limits) {
        const auto known = std::find_if(kLimits.begin(), kLimits.end(), [&](const Limit& limit) {
            return limit.name == name;
        });
        if (known == kLimits.end())
            refuse("'" + name + "' is no limit that this layer knows");
        uint32_t& limit = properties.limits.*known->value;
        limit = std::min(limit, value);
    }
}

void report(VkPhysicalDeviceProperties2& properties) {
    report(properties.properties);
}

/// A feature, at its place in a struct of a chain.
struct Feature {
    const char* name;
    VkStructureType type;
    size_t offset;
};

#define SHUTTER_FEATURE(name, Struct, type)                                                        \
    Feature {                                                                                      \
#name, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_##type, offsetof(Struct, name)                    \
    }
constexpr std::array kFeatures{
    SHUTTER_FEATURE(timelineSemaphore, VkPhysicalDeviceVulkan12Features, VULKAN_1_2_FEATURES),
    SHUTTER_FEATURE(bufferDeviceAddress, VkPhysicalDeviceVulkan12Features, VULKAN_1_2_FEATURES),
    SHUTTER_FEATURE(scalarBlockLayout, VkPhysicalDeviceVulkan12Features, VULKAN_1_2_FEATURES),
    SHUTTER_FEATURE(hostQueryReset, VkPhysicalDeviceVulkan12Features, VULKAN_1_2_FEATURES),
    SHUTTER_FEATURE(dynamicRendering, VkPhysicalDeviceVulkan13Features, VULKAN_1_3_FEATURES),
    SHUTTER_FEATURE(synchronization2, VkPhysicalDeviceVulkan13Features, VULKAN_1_3_FEATURES),
    SHUTTER_FEATURE(maintenance4, VkPhysicalDeviceVulkan13Features, VULKAN_1_3_FEATURES),
    SHUTTER_FEATURE(
        accelerationStructure,
        VkPhysicalDeviceAccelerationStructureFeaturesKHR,
        ACCELERATION_STRUCTURE_FEATURES_KHR
    ),
    SHUTTER_FEATURE(rayQuery, VkPhysicalDeviceRayQueryFeaturesKHR, RAY_QUERY_FEATURES_KHR),
    SHUTTER_FEATURE(
        rayTracingPipeline,
        VkPhysicalDeviceRayTracingPipelineFeaturesKHR,
        RAY_TRACING_PIPELINE_FEATURES_KHR
    ),
    SHUTTER_FEATURE(
        rayTracingPipelineTraceRaysIndirect,
        VkPhysicalDeviceRayTracingPipelineFeaturesKHR,
        RAY_TRACING_PIPELINE_FEATURES_KHR
    ),
};
#undef SHUTTER_FEATURE

bool isHidden(const char* name) {
    return FaultPlan::get().hidden.contains(name);
}

void report(VkPhysicalDeviceFeatures& features) {
    if (isHidden("shaderStorageImageExtendedFormats"))
        features.shaderStorageImageExtendedFormats = VK_FALSE;
    if (isHidden("independentBlend"))
        features.independentBlend = VK_FALSE;
}

void report(VkPhysicalDeviceFeatures2& features) {
    report(features.features);
    for (auto* part = static_cast<VkBaseOutStructure*>(features.pNext); part; part = part->pNext)
        for (const Feature& feature : kFeatures)
            if (part->sType == feature.type && isHidden(feature.name))
                std::memset(
                    reinterpret_cast<char*>(part) + feature.offset, 0, sizeof(VkBool32) // VK_FALSE
                );
}

/// One heap each, as large as the device's first.
void report(VkPhysicalDeviceMemoryProperties& memory) {
    if (isHidden("hostCoherent"))
        for (VkMemoryType& type : memory.memoryTypes)
            type.propertyFlags &= ~VkMemoryPropertyFlags{VK_MEMORY_PROPERTY_HOST_COHERENT_BIT};
    const auto& types = FaultPlan::get().memoryTypes;
    if (types.empty())
        return;
    const VkMemoryHeap heap = memory.memoryHeaps[0];
    memory.memoryTypeCount = static_cast<uint32_t>(types.size());
    memory.memoryHeapCount = 2;
    memory.memoryHeaps[0] = {heap.size, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
    memory.memoryHeaps[1] = {heap.size, 0};
    for (uint32_t i = 0; i < types.size(); ++i)
        memory.memoryTypes[i] = {
            types[i], (types[i] & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) != 0 ? 0u : 1u};
}

void report(VkPhysicalDeviceMemoryProperties2& memory) {
    report(memory.memoryProperties);
}

/// Replaces a function that describes a physical device.
template <auto next> struct Describe;

template <class Info, void (VKAPI_PTR* InstanceTable::*next)(VkPhysicalDevice, Info*)>
struct Describe<next> {
    static VKAPI_ATTR void VKAPI_CALL call(VkPhysicalDevice device, Info* info) {
        (findInstance(device).*next)(device, info);
        report(*info);
    }
};

VKAPI_ATTR VkResult VKAPI_CALL enumerateExtensions(
    VkPhysicalDevice device, const char* layer, uint32_t* count, VkExtensionProperties* properties
) {
    const InstanceTable& next = findInstance(device);
    uint32_t all = 0;
    VkResult result = next.EnumerateDeviceExtensionProperties(device, layer, &all, nullptr);
    std::vector<VkExtensionProperties> extensions(all);
    if (result == VK_SUCCESS)
        result = next.EnumerateDeviceExtensionProperties(device, layer, &all, extensions.data());
    if (result != VK_SUCCESS)
        return result;
    std::erase_if(extensions, [](const VkExtensionProperties& extension) {
        return isHidden(extension.extensionName);
    });
    const auto shown = static_cast<uint32_t>(extensions.size());
    if (!properties) {
        *count = shown;
        return VK_SUCCESS;
    }
    *count = std::min(*count, shown);
    std::copy_n(extensions.begin(), *count, properties);
    return *count < shown ? VK_INCOMPLETE : VK_SUCCESS;
}

} // namespace

std::span<const test::LayerEntry> listReports() {
#define SHUTTER_DESCRIBE(name) SHUTTER_ENTRY(name, Describe<&InstanceTable::name>::call)
    static const std::array sEntries{
        SHUTTER_ENTRY(EnumerateDeviceExtensionProperties, enumerateExtensions),
        SHUTTER_DESCRIBE(GetPhysicalDeviceFeatures),
        SHUTTER_DESCRIBE(GetPhysicalDeviceFeatures2),
        SHUTTER_DESCRIBE(GetPhysicalDeviceMemoryProperties),
        SHUTTER_DESCRIBE(GetPhysicalDeviceMemoryProperties2),
        SHUTTER_DESCRIBE(GetPhysicalDeviceProperties),
        SHUTTER_DESCRIBE(GetPhysicalDeviceProperties2),
    };
#undef SHUTTER_DESCRIBE
    return sEntries;
}

} // namespace shutter::faults
