// SPDX-License-Identifier: MIT
#include "engine/gpu/vulkan_functions.h"

#include "engine/core/platform.h"

#ifndef SHUTTER_LOADS_VULKAN
#error "what defines the pointers must declare them"
#endif

namespace shutter {

#define SHUTTER_DEFINE(name) PFN_vk##name vk##name = nullptr;
SHUTTER_VULKAN_FUNCTIONS(SHUTTER_DEFINE)
#undef SHUTTER_DEFINE

namespace gpu {

namespace {

/// The name of the loader, by its interface's version, and what brings it.
#ifdef _WIN32
constexpr const char* kLoader = "vulkan-1.dll";
constexpr const char* kSource = "a driver of the graphics card";
#else
constexpr const char* kLoader = "libvulkan.so.1";
constexpr const char* kSource = "package libvulkan1";
#endif

core::Status findAll() {
    // Never closed: drivers and layers may leave threads and handlers behind.
    const core::Result<void*> loader = core::openLibrary(kLoader);
    if (!loader)
        return core::makeError("there is no Vulkan: {} ({})", loader.error().message, kSource);
#define SHUTTER_FIND(name)                                                                         \
    vk##name = reinterpret_cast<PFN_vk##name>(core::findFunction(loader.value(), "vk" #name));     \
    if (!vk##name)                                                                                 \
        return core::makeError("{} is too old: it lacks vk" #name, kLoader);
    SHUTTER_VULKAN_FUNCTIONS(SHUTTER_FIND)
#undef SHUTTER_FIND
    return {};
}

} // namespace

core::Status loadVulkan() {
    static const core::Status sFound = findAll();
    return sFound;
}

} // namespace gpu

} // namespace shutter
