// SPDX-License-Identifier: MIT
// Opens Vulkan, with validation where DeviceOptions want it.
#include "engine/core/log.h"
#include "engine/gpu/device.h"

#include <array>
#include <cstring>
#include <string>

namespace shutter::gpu {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
/// Part of the names of messages that advise and find nothing wrong.
constexpr const char* kAdvice = "BestPractices";

/// The message with its name, by which older layers begin it and which newer ones leave out.
std::string describe(const VkDebugUtilsMessengerCallbackDataEXT& data) {
    const char* name = data.pMessageIdName ? data.pMessageIdName : "";
    return std::strstr(data.pMessage, name) ? data.pMessage
                                            : fmt::format("[ {} ] {}", name, data.pMessage);
}

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(
    VkDebugUtilsMessageSeverityFlagBitsEXT,
    VkDebugUtilsMessageTypeFlagsEXT,
    const VkDebugUtilsMessengerCallbackDataEXT* data,
    void* user
) {
    const char* id = data->pMessageIdName ? data->pMessageIdName : "";
    if (std::strstr(id, kAdvice)) {
        core::logWarning("Vulkan advice: {}", describe(*data));
        return VK_FALSE;
    }
    ++*static_cast<std::atomic<uint32_t>*>(user);
    core::logWarning("Vulkan validation: {}", describe(*data));
    return VK_FALSE;
}

bool hasLayer(const char* wanted) {
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    for (const auto& layer : layers)
        if (std::strcmp(layer.layerName, wanted) == 0)
            return true;
    return false;
}

/// \param layer whose extensions are queried; null: those of the loader and the drivers
bool hasInstanceExtension(const char* wanted, const char* layer = nullptr) {
    uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(layer, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data());
    for (const auto& extension : extensions)
        if (std::strcmp(extension.extensionName, wanted) == 0)
            return true;
    return false;
}

} // namespace

void listPortableDrivers(VkInstanceCreateFlags& flags, std::vector<const char*>& extensions) {
    if (!hasInstanceExtension(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME))
        return;
    flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;
    extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
}

core::Status Device::createInstance(const DeviceOptions& options) {
    SHUTTER_TRY(loadVulkan());
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "shutter";
    application.pEngineName = "shutter";
    application.apiVersion = VK_API_VERSION_1_3;

    std::vector<const char*> layers;
    std::vector<const char*> extensions;
    for (const std::string& wanted : options.surfaceExtensions)
        extensions.push_back(wanted.c_str());
    mHasDebugUtils = hasInstanceExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (options.validate) {
        if (!hasLayer(kValidationLayer))
            return core::makeError(
                "--validate: the layer {} is not installed (package "
                "vulkan-validationlayers)",
                kValidationLayer
            );
        layers.push_back(kValidationLayer);
        if (!hasInstanceExtension(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME, kValidationLayer))
            return core::makeError("--validate: {} cannot check synchronization", kValidationLayer);
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
        mHasDebugUtils = true;
    }
    if (mHasDebugUtils)
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    VkDebugUtilsMessengerCreateInfoEXT messenger{
        VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                                VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    // Not the loader's general ones: a broken driver of another device is no fault of this program.
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    if (options.wantsAdvice)
        messenger.messageType |= VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    messenger.pfnUserCallback = onMessage;
    messenger.pUserData = &mValidationMessages;

    const std::array enabled{
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT,
        VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT};
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messenger};
    features.enabledValidationFeatureCount = options.wantsAdvice ? 2 : 1;
    features.pEnabledValidationFeatures = enabled.data();

    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    listPortableDrivers(info.flags, extensions);
    if (options.validate)
        info.pNext = &features;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = static_cast<uint32_t>(layers.size());
    info.ppEnabledLayerNames = layers.data();
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    require(vkCreateInstance(&info, nullptr, &mInstance), "creating the Vulkan instance");

    if (options.validate) {
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(mInstance, "vkCreateDebugUtilsMessengerEXT")
        );
        require(create(mInstance, &messenger, nullptr, &mMessenger), "listening to validation");
    }
    return {};
}

} // namespace shutter::gpu
