// SPDX-License-Identifier: MIT
#include "engine/gpu/vulkan_functions.h"

#include <dlfcn.h>

#ifndef SHUTTER_LOADS_VULKAN
#error "what defines the pointers must declare them"
#endif

namespace shutter {

#define SHUTTER_DEFINE(name) PFN_vk##name vk##name = nullptr;
SHUTTER_VULKAN_FUNCTIONS(SHUTTER_DEFINE)
#undef SHUTTER_DEFINE

namespace gpu {

namespace {

/// The name of the loader on Linux, by its interface's version.
constexpr const char* kLoader = "libvulkan.so.1";

core::Status findAll() {
    // Never closed: drivers and layers leave threads and handlers of their own.
    void* const loader = dlopen(kLoader, RTLD_NOW | RTLD_LOCAL);
    if (!loader)
        return core::makeError("there is no Vulkan: {} (package libvulkan1)", dlerror());
#define SHUTTER_FIND(name)                                                                         \
    vk##name = reinterpret_cast<PFN_vk##name>(dlsym(loader, "vk" #name));                          \
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
