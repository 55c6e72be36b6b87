// SPDX-License-Identifier: MIT
#include "engine/gpu/device_select.h"

#include "engine/gpu/device_features.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <system_error>

namespace shutter::gpu {

namespace {

const char* describeKind(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "software";
    default:
        return "other";
    }
}

/// Most methods trace no rays, and a software device takes a hundred times as long: it comes last,
/// whatever it can.
int rankOf(const DeviceInfo& info) {
    int rank = info.kind == "software" ? 0 : 200;
    if (info.rayTier != RayTier::None)
        rank += 100;
    if (info.rayTier == RayTier::RayQuery)
        rank += 5;
    if (info.kind == "discrete")
        rank += 40;
    if (info.kind == "integrated")
        rank += 30;
    if (info.kind == "virtual")
        rank += 20;
    return rank;
}

bool hasExtension(const std::vector<VkExtensionProperties>& extensions, const char* name) {
    return std::any_of(extensions.begin(), extensions.end(), [&](const auto& extension) {
        return std::strcmp(extension.extensionName, name) == 0;
    });
}

std::vector<VkExtensionProperties> listExtensions(VkPhysicalDevice device) {
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
    return extensions;
}

/// Vulkan's headers name it only together with all other beta extensions.
constexpr const char* kPortabilitySubset = "VK_KHR_portability_subset";

void findRobustness(DeviceInfo& info, const std::vector<VkExtensionProperties>& extensions) {
    if (!hasExtension(extensions, VK_EXT_ROBUSTNESS_2_EXTENSION_NAME))
        return;
    VkPhysicalDeviceRobustness2FeaturesEXT robust{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &robust};
    vkGetPhysicalDeviceFeatures2(info.handle, &features);
    info.hasRobustness2 = robust.robustBufferAccess2 && robust.robustImageAccess2;
}

void findRays(DeviceInfo& info, const std::vector<VkExtensionProperties>& extensions) {
    if (!hasExtension(extensions, VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME) ||
        !hasExtension(extensions, VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME))
        return;
    const bool query = hasExtension(extensions, VK_KHR_RAY_QUERY_EXTENSION_NAME);
    const bool pipeline = hasExtension(extensions, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structures{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
    VkPhysicalDeviceRayQueryFeaturesKHR queries{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR};
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipelines{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
    // Structs of extensions that are not there must not be in the chain.
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &structures};
    if (query) {
        queries.pNext = structures.pNext;
        structures.pNext = &queries;
    }
    if (pipeline) {
        pipelines.pNext = structures.pNext;
        structures.pNext = &pipelines;
    }
    vkGetPhysicalDeviceFeatures2(info.handle, &features);
    info.hasRayQuery = structures.accelerationStructure && queries.rayQuery;
    info.hasRayPipeline = structures.accelerationStructure && pipelines.rayTracingPipeline;
    info.tracesIndirect = info.hasRayPipeline && pipelines.rayTracingPipelineTraceRaysIndirect;
}

std::vector<QueueFamily> listQueueFamilies(VkPhysicalDevice device, VkSurfaceKHR surface) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> properties(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, properties.data());
    std::vector<QueueFamily> families;
    for (uint32_t i = 0; i < count; ++i) {
        VkBool32 presents = VK_FALSE;
        // An error is a no as well.
        if (surface != VK_NULL_HANDLE)
            vkGetPhysicalDeviceSurfaceSupportKHR(device, i, surface, &presents);
        families.push_back(
            {properties[i].queueFlags, properties[i].timestampValidBits, presents == VK_TRUE}
        );
    }
    return families;
}

/// Notes the queue family and the first thing that is missing.
void findMissing(DeviceInfo& info, VkSurfaceKHR surface) {
    if (info.apiVersion < VK_API_VERSION_1_3) {
        info.missing = "Vulkan 1.3";
        return;
    }
    DeviceFeatures features;
    vkGetPhysicalDeviceFeatures2(info.handle, &features.core);
    info.missing = features.findMissing();
    if (!info.missing.empty())
        return;
    const bool mustPresent = surface != VK_NULL_HANDLE;
    const std::vector<QueueFamily> families = listQueueFamilies(info.handle, surface);
    const auto family = chooseQueueFamily(families, mustPresent);
    if (!chooseQueueFamily(families, false))
        info.missing = "a queue for graphics, compute and timestamps";
    else if (!family)
        info.missing = "a queue that shows pictures on this display";
    else if (mustPresent && !hasExtension(listExtensions(info.handle), VK_KHR_SWAPCHAIN_EXTENSION_NAME))
        info.missing = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    info.queueFamily = family.value_or(0);
    info.timestampBits = family ? families[*family].timestampBits : 0;
}

std::string toLower(std::string text) {
    for (char& c : text)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string listNames(const std::vector<DeviceInfo>& devices) {
    std::string names;
    for (size_t i = 0; i < devices.size(); ++i)
        names += fmt::format("{}{}: {}", i ? ", " : "", i, devices[i].name);
    return names;
}

} // namespace

const char* describe(RayTier tier) {
    switch (tier) {
    case RayTier::RayQuery:
        return "VK_KHR_ray_query";
    case RayTier::Pipeline:
        return "VK_KHR_ray_tracing_pipeline";
    case RayTier::None:
        break;
    }
    return "none";
}

std::string describeTiers(const DeviceInfo& device) {
    std::string words;
    if (device.hasRayQuery)
        words = describe(RayTier::RayQuery);
    if (device.hasRayPipeline)
        words += fmt::format("{}{}", words.empty() ? "" : ", ", describe(RayTier::Pipeline));
    return words.empty() ? describe(RayTier::None) : words;
}

RayTier chooseTier(const DeviceInfo& device, RayTier best) {
    if (best <= RayTier::RayQuery && device.hasRayQuery)
        return RayTier::RayQuery;
    if (best <= RayTier::Pipeline && device.hasRayPipeline)
        return RayTier::Pipeline;
    return RayTier::None;
}

std::optional<uint32_t> chooseQueueFamily(std::span<const QueueFamily> families, bool mustPresent) {
    constexpr VkQueueFlags kWanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < families.size(); ++i)
        if ((families[i].flags & kWanted) == kWanted && families[i].timestampBits > 0 &&
            (families[i].presents || !mustPresent))
            return i;
    return std::nullopt;
}

DeviceInfo describeDevice(VkPhysicalDevice device, VkSurfaceKHR surface) {
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
    vkGetPhysicalDeviceProperties2(device, &properties);
    DeviceInfo info;
    info.handle = device;
    info.name = properties.properties.deviceName;
    info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    info.kind = describeKind(properties.properties.deviceType);
    info.apiVersion = properties.properties.apiVersion;
    findMissing(info, surface);
    const auto extensions = listExtensions(device);
    info.isPortable = hasExtension(extensions, kPortabilitySubset);
    findRobustness(info, extensions);
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, nullptr};
    vkGetPhysicalDeviceFeatures2(device, &features);
    info.interpolatesAnywhere = features.features.sampleRateShading;
    findRays(info, extensions);
    info.rayTier = chooseTier(info, RayTier::RayQuery);
    return info;
}

std::vector<DeviceInfo> listDevices(VkInstance instance, VkSurfaceKHR surface) {
    uint32_t count = 0;
    vkEnumeratePhysicalDevices(instance, &count, nullptr);
    std::vector<VkPhysicalDevice> handles(count);
    vkEnumeratePhysicalDevices(instance, &count, handles.data());

    std::vector<DeviceInfo> devices;
    for (VkPhysicalDevice handle : handles)
        devices.push_back(describeDevice(handle, surface));
    return devices;
}

std::vector<const char*>
listDeviceExtensions(const DeviceInfo& device, bool presents, Bounds bounds) {
    std::vector<const char*> extensions;
    if (device.rayTier != RayTier::None)
        extensions = {
            VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
            VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,
            device.rayTier == RayTier::RayQuery ? VK_KHR_RAY_QUERY_EXTENSION_NAME
                                                : VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME};
    if (presents)
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    if (device.isPortable) // a device that has it must be made with it
        extensions.push_back(kPortabilitySubset);
    if (bounds == Bounds::Checked && device.hasRobustness2)
        extensions.push_back(VK_EXT_ROBUSTNESS_2_EXTENSION_NAME);
    return extensions;
}

core::Result<DeviceInfo>
chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& wanted) {
    if (devices.empty())
        return core::makeError(
            "no Vulkan device was found; Mesa's lavapipe is one that always works "
            "(package mesa-vulkan-drivers)"
        );
    const DeviceInfo* best = nullptr;
    if (wanted.empty()) {
        for (const DeviceInfo& device : devices)
            if (device.missing.empty() && (!best || rankOf(device) > rankOf(*best)))
                best = &device;
        if (!best)
            return core::makeError(
                "no device can run the engine: {} lacks {}", devices[0].name, devices[0].missing
            );
        return *best;
    }
    size_t index = 0;
    const auto [end, problem] =
        std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (problem == std::errc() && end == wanted.data() + wanted.size()) {
        if (index < devices.size())
            best = &devices[index];
    } else {
        for (const DeviceInfo& device : devices)
            if (!best && toLower(device.name).find(toLower(wanted)) != std::string::npos)
                best = &device;
    }
    if (!best)
        return core::makeError(
            "--device '{}' names none of the devices ({})", wanted, listNames(devices)
        );
    if (!best->missing.empty())
        return core::makeError("--device '{}': {} lacks {}", wanted, best->name, best->missing);
    return *best;
}

std::vector<std::string>
describePassedOver(const std::vector<DeviceInfo>& devices, const DeviceInfo& chosen) {
    std::vector<std::string> sentences;
    for (const DeviceInfo& device : devices)
        if (!device.missing.empty() && rankOf(device) > rankOf(chosen))
            sentences.push_back(fmt::format(
                "{} is passed over for {}: it lacks {}", device.name, chosen.name, device.missing
            ));
    return sentences;
}

} // namespace shutter::gpu
