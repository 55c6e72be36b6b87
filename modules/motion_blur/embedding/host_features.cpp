// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_features.h"

#include <array>
#include <vector>

namespace shutter::motion_blur {

namespace {

constexpr std::array kQueryExtensions{
    VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,
    VK_KHR_RAY_QUERY_EXTENSION_NAME};
constexpr std::array kPipelineExtensions{
    VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,
    VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME};

/// What of 1.2 the reveal's shaders need for the bindless textures of what they meet.
constexpr VkBool32 VkPhysicalDeviceVulkan12Features::*kBindless[] = {
    &VkPhysicalDeviceVulkan12Features::descriptorIndexing,
    &VkPhysicalDeviceVulkan12Features::runtimeDescriptorArray,
    &VkPhysicalDeviceVulkan12Features::shaderSampledImageArrayNonUniformIndexing};

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
using Indexing = VkPhysicalDeviceDescriptorIndexingFeatures;
using Structures = VkPhysicalDeviceAccelerationStructureFeaturesKHR;
using Query = VkPhysicalDeviceRayQueryFeaturesKHR;
using Pipelines = VkPhysicalDeviceRayTracingPipelineFeaturesKHR;

constexpr VkStructureType kV12 = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
constexpr VkStructureType kV13 = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
constexpr VkStructureType kIndexing =
    VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_FEATURES;
constexpr VkStructureType kStructures =
    VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
constexpr VkStructureType kQuery = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
constexpr VkStructureType kPipelines =
    VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR;

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
        "maintenance4",
        kV13,
        SHUTTER_IN(V13, maintenance4),
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES,
        SHUTTER_IN(VkPhysicalDeviceMaintenance4Features, maintenance4)}};
constexpr std::array kRayFeatures{
    Feature{
        "runtimeDescriptorArray",
        kV12,
        SHUTTER_IN(V12, runtimeDescriptorArray),
        kIndexing,
        SHUTTER_IN(Indexing, runtimeDescriptorArray)},
    Feature{
        "shaderSampledImageArrayNonUniformIndexing",
        kV12,
        SHUTTER_IN(V12, shaderSampledImageArrayNonUniformIndexing),
        kIndexing,
        SHUTTER_IN(Indexing, shaderSampledImageArrayNonUniformIndexing)},
    Feature{
        "accelerationStructure",
        kStructures,
        SHUTTER_IN(Structures, accelerationStructure),
        kStructures,
        SHUTTER_IN(Structures, accelerationStructure)}};
constexpr Feature kQueryFeature{
    "rayQuery", kQuery, SHUTTER_IN(Query, rayQuery), kQuery, SHUTTER_IN(Query, rayQuery)};
constexpr Feature kPipelineFeature{
    "rayTracingPipeline",
    kPipelines,
    SHUTTER_IN(Pipelines, rayTracingPipeline),
    kPipelines,
    SHUTTER_IN(Pipelines, rayTracingPipeline)};
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

std::vector<Feature> listFeatures(gpu::RayTier rays) {
    std::vector<Feature> features(kFeatures.begin(), kFeatures.end());
    if (rays == gpu::RayTier::None)
        return features;
    features.insert(features.end(), kRayFeatures.begin(), kRayFeatures.end());
    features.push_back(rays == gpu::RayTier::RayQuery ? kQueryFeature : kPipelineFeature);
    return features;
}

} // namespace

core::Status addHostFeatures(VkPhysicalDeviceFeatures2& chain, gpu::RayTier rays) {
    std::vector<VkBool32*> wanted;
    for (const Feature& feature : listFeatures(rays)) {
        VkBool32* const found = findIn(chain, feature);
        if (!found)
            return core::makeError(
                "motion blur: the chain of features has no structure with {}", feature.name
            );
        wanted.push_back(found);
    }
    for (VkBool32* const feature : wanted)
        *feature = VK_TRUE;
    chain.features.shaderStorageImageExtendedFormats = VK_TRUE;
    if (rays == gpu::RayTier::None)
        return {};
    chain.features.shaderSampledImageArrayDynamicIndexing = VK_TRUE;
    // Vulkan 1.2's structure has one more for the whole of descriptor indexing.
    for (auto* at = static_cast<VkBaseOutStructure*>(chain.pNext); at; at = at->pNext)
        if (at->sType == kV12)
            reinterpret_cast<V12*>(at)->descriptorIndexing = VK_TRUE;
    return {};
}

core::Status checkEnabledFeatures(const VkPhysicalDeviceFeatures2& enabled, gpu::RayTier rays) {
    const auto lacks = [](const char* name) {
        return core::makeError("motion blur: enabledFeatures lacks {}", name);
    };
    if (!enabled.features.shaderStorageImageExtendedFormats)
        return lacks("shaderStorageImageExtendedFormats");
    if (rays != gpu::RayTier::None && !enabled.features.shaderSampledImageArrayDynamicIndexing)
        return lacks("shaderSampledImageArrayDynamicIndexing");
    auto& chain = const_cast<VkPhysicalDeviceFeatures2&>(enabled); // nothing is written to it
    for (const Feature& feature : listFeatures(rays)) {
        const VkBool32* const found = findIn(chain, feature);
        if (!found || !*found)
            return lacks(feature.name);
    }
    return {};
}

HostFeatures::HostFeatures(gpu::RayTier rays) : mRays(rays) {
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    mStructure.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
    mQuery.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
    mPipeline.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR;
    features.pNext = &v12;
    v12.pNext = &v13;
    features.features.shaderStorageImageExtendedFormats = VK_TRUE; // images of two channels
    v12.bufferDeviceAddress = VK_TRUE;
    v12.scalarBlockLayout = VK_TRUE;
    v13.synchronization2 = VK_TRUE;
    v13.maintenance4 = VK_TRUE; // glslang gives workgroup sizes as LocalSizeId
    if (rays == gpu::RayTier::None)
        return;
    features.features.shaderSampledImageArrayDynamicIndexing = VK_TRUE;
    for (const auto feature : kBindless)
        v12.*feature = VK_TRUE;
    v13.pNext = &mStructure;
    mStructure.accelerationStructure = VK_TRUE;
    mQuery.rayQuery = VK_TRUE;
    mPipeline.rayTracingPipeline = VK_TRUE;
    mStructure.pNext = &mPipeline;
    if (rays == gpu::RayTier::RayQuery)
        mStructure.pNext = &mQuery;
}

std::span<const char* const> HostFeatures::extensions() const {
    switch (mRays) {
    case gpu::RayTier::RayQuery:
        return kQueryExtensions;
    case gpu::RayTier::Pipeline:
        return kPipelineExtensions;
    case gpu::RayTier::None:
        break;
    }
    return {};
}

core::Status checkHostDevice(VkPhysicalDevice device, uint32_t queueFamily, gpu::RayTier rays) {
    SHUTTER_TRY(gpu::loadVulkan());
    const gpu::DeviceInfo info = gpu::describeDevice(device);
    const auto lacks = [&](const char* what) {
        return core::makeError("motion blur: {} lacks {}", info.name, what);
    };
    if (info.apiVersion < VK_API_VERSION_1_3)
        return lacks("Vulkan 1.3");
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
    vkGetPhysicalDeviceFeatures2(device, &features);
    // Each device of Vulkan 1.3 has them; an instance that is made for less does not ask the
    // driver.
    if (!v12.bufferDeviceAddress && !v13.synchronization2 && !v13.maintenance4)
        return core::makeError("motion blur: the instance is not made for Vulkan 1.3 "
                               "(VkApplicationInfo::apiVersion)");
    if (!features.features.shaderStorageImageExtendedFormats)
        return lacks("shaderStorageImageExtendedFormats");
    if (!v12.bufferDeviceAddress)
        return lacks("bufferDeviceAddress");
    if (!v12.scalarBlockLayout)
        return lacks("scalarBlockLayout");
    if (!v13.synchronization2)
        return lacks("synchronization2");
    if (!v13.maintenance4)
        return lacks("maintenance4");
    if (rays != gpu::RayTier::None && !features.features.shaderSampledImageArrayDynamicIndexing)
        return lacks("shaderSampledImageArrayDynamicIndexing");
    for (const auto feature : kBindless)
        if (rays != gpu::RayTier::None && !(v12.*feature))
            return lacks("descriptor indexing");
    if ((rays == gpu::RayTier::RayQuery && !info.hasRayQuery) ||
        (rays == gpu::RayTier::Pipeline && !info.hasRayPipeline))
        return lacks(gpu::describe(rays));

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
