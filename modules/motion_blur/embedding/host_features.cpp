// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_features.h"

#include "engine/gpu/device_select.h"

#include <array>
#include <vector>

namespace shutter::motion_blur {

namespace {

/// A feature, in the structure of the Vulkan version that took it up or in the one that it came
/// with.
struct Feature {
    const char* name;
    VkStructureType type;
    VkBool32* (*find)(VkBaseOutStructure* structure);
    VkStructureType firstType;
    VkBool32* (*findFirst)(VkBaseOutStructure* structure);
};

template <class Structure, VkBool32 Structure::*member>
VkBool32* findMember(VkBaseOutStructure* structure) {
    return &(reinterpret_cast<Structure*>(structure)->*member);
}

using V12 = VkPhysicalDeviceVulkan12Features;
using V13 = VkPhysicalDeviceVulkan13Features;

constexpr VkStructureType kV12 = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
constexpr VkStructureType kV13 = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;

#define SHUTTER_IN(Structure, member) findMember<Structure, &Structure::member>
constexpr std::array kFeatures{
    Feature{
        "bufferDeviceAddress",
        kV12,
        SHUTTER_IN(V12, bufferDeviceAddress),
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES,
        SHUTTER_IN(VkPhysicalDeviceBufferDeviceAddressFeatures, bufferDeviceAddress)},
    Feature{
        "scalarBlockLayout",
        kV12,
        SHUTTER_IN(V12, scalarBlockLayout),
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES,
        SHUTTER_IN(VkPhysicalDeviceScalarBlockLayoutFeatures, scalarBlockLayout)},
    Feature{
        "synchronization2",
        kV13,
        SHUTTER_IN(V13, synchronization2),
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES,
        SHUTTER_IN(VkPhysicalDeviceSynchronization2Features, synchronization2)},
    Feature{
        "maintenance4", // glslang gives workgroup sizes as LocalSizeId
        kV13,
        SHUTTER_IN(V13, maintenance4),
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES,
        SHUTTER_IN(VkPhysicalDeviceMaintenance4Features, maintenance4)}};
/// Not required: without, drivers choose how large subgroups are.
constexpr Feature kSubgroupSizes{
    "subgroupSizeControl",
    kV13,
    SHUTTER_IN(V13, subgroupSizeControl),
    VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES,
    SHUTTER_IN(VkPhysicalDeviceSubgroupSizeControlFeatures, subgroupSizeControl)};
#undef SHUTTER_IN

/// Null: no structure of the chain has it.
VkBool32* findIn(VkPhysicalDeviceFeatures2& chain, const Feature& feature) {
    for (auto* at = static_cast<VkBaseOutStructure*>(chain.pNext); at; at = at->pNext) {
        if (at->sType == feature.type)
            return feature.find(at);
        if (at->sType == feature.firstType)
            return feature.findFirst(at);
    }
    return nullptr;
}

/// The first that the chain does not have; null: it has all.
const char* findLacking(const VkPhysicalDeviceFeatures2& chain) {
    if (!chain.features.shaderStorageImageExtendedFormats)
        return "shaderStorageImageExtendedFormats";
    auto& readOnly = const_cast<VkPhysicalDeviceFeatures2&>(chain); // nothing is written to it
    for (const Feature& feature : kFeatures) {
        const VkBool32* const found = findIn(readOnly, feature);
        if (!found || !*found)
            return feature.name;
    }
    return nullptr;
}

} // namespace

core::Status addHostFeatures(VkPhysicalDeviceFeatures2& chain) {
    std::vector<VkBool32*> wanted;
    for (const Feature& feature : kFeatures) {
        VkBool32* const found = findIn(chain, feature);
        if (!found)
            return core::makeError(
                "motion blur: the chain of features has no structure with {}", feature.name
            );
        wanted.push_back(found);
    }
    if (VkBool32* const found = findIn(chain, kSubgroupSizes))
        wanted.push_back(found);
    for (VkBool32* const feature : wanted)
        *feature = VK_TRUE;
    chain.features.shaderStorageImageExtendedFormats = VK_TRUE; // images of two channels
    return {};
}

core::Status checkEnabledFeatures(const VkPhysicalDeviceFeatures2& enabled) {
    const char* const lacking = findLacking(enabled);
    return lacking ? core::makeError("motion blur: enabledFeatures lacks {}", lacking)
                   : core::Status();
}

bool enablesSubgroupSizes(const VkPhysicalDeviceFeatures2& enabled) {
    auto& readOnly = const_cast<VkPhysicalDeviceFeatures2&>(enabled); // nothing is written to it
    const VkBool32* const found = findIn(readOnly, kSubgroupSizes);
    return found && *found;
}

core::Status checkHostDevice(VkPhysicalDevice device, uint32_t queueFamily) {
    SHUTTER_TRY(gpu::loadVulkan());
    const gpu::DeviceInfo info = gpu::describeDevice(device);
    if (info.apiVersion < VK_API_VERSION_1_3)
        return core::makeError("motion blur: {} lacks Vulkan 1.3", info.name);
    V13 v13{kV13};
    V12 v12{kV12, &v13};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
    vkGetPhysicalDeviceFeatures2(device, &features);
    // Every Vulkan 1.3 device has them; an instance of a lower version does not query the driver.
    if (!v12.bufferDeviceAddress && !v13.synchronization2 && !v13.maintenance4)
        return core::makeError("motion blur: the instance is not made for Vulkan 1.3 "
                               "(VkApplicationInfo::apiVersion)");
    if (const char* const lacking = findLacking(features))
        return core::makeError("motion blur: {} lacks {}", info.name, lacking);

    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    if (queueFamily >= count || !(families[queueFamily].queueFlags & VK_QUEUE_COMPUTE_BIT))
        return core::makeError(
            "motion blur: queueFamily {} of {} runs no compute shaders", queueFamily, info.name
        );
    return {};
}

} // namespace shutter::motion_blur
