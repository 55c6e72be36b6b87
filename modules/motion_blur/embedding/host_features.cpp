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

} // namespace

HostFeatures::HostFeatures(gpu::RayTier rays) : mRays(rays) {
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
