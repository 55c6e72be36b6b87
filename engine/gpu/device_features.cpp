// SPDX-License-Identifier: MIT
#include "engine/gpu/device_features.h"

#include <array>

namespace shutter::gpu {

namespace {

using Core = VkPhysicalDeviceFeatures;
using V12 = VkPhysicalDeviceVulkan12Features;
using V13 = VkPhysicalDeviceVulkan13Features;

template <class Struct> struct Row {
    VkBool32 Struct::*feature;
    const char* words;
};

constexpr std::array kCoreRows{
    Row<Core>{&Core::shaderStorageImageExtendedFormats, "extended storage formats"},
    Row<Core>{&Core::shaderSampledImageArrayDynamicIndexing, "dynamic indexing of textures"},
    Row<Core>{&Core::independentBlend, "independent blending"},
};
constexpr std::array kRows12{
    Row<V12>{&V12::timelineSemaphore, "timeline semaphores"},
    Row<V12>{&V12::bufferDeviceAddress, "buffer device addresses"},
    Row<V12>{&V12::descriptorIndexing, "descriptor indexing"},
    Row<V12>{&V12::runtimeDescriptorArray, "descriptor indexing"},
    Row<V12>{&V12::shaderSampledImageArrayNonUniformIndexing, "descriptor indexing"},
    Row<V12>{&V12::descriptorBindingPartiallyBound, "descriptor indexing"},
    Row<V12>{&V12::scalarBlockLayout, "scalar block layout"},
    Row<V12>{&V12::hostQueryReset, "host query reset"},
};
constexpr std::array kRows13{
    Row<V13>{&V13::dynamicRendering, "dynamic rendering"},
    Row<V13>{&V13::synchronization2, "synchronization2"},
    Row<V13>{&V13::maintenance4, "maintenance4"}, // glslang gives workgroup sizes as LocalSizeId
    Row<V13>{&V13::subgroupSizeControl, "subgroup size control"},
    Row<V13>{&V13::shaderTerminateInvocation, "terminating invocations"}, // what `discard` becomes
};

/// The first row that is not set, in words; null where all are.
template <class Struct, size_t n>
const char* findUnset(const Struct& features, const std::array<Row<Struct>, n>& rows) {
    for (const Row<Struct>& row : rows)
        if (!(features.*row.feature))
            return row.words;
    return nullptr;
}

} // namespace

DeviceFeatures::DeviceFeatures() {
    core.pNext = &v12;
    v12.pNext = &v13;
}

void DeviceFeatures::enableNeeded() {
    for (const auto& row : kCoreRows)
        core.features.*row.feature = VK_TRUE;
    for (const auto& row : kRows12)
        v12.*row.feature = VK_TRUE;
    for (const auto& row : kRows13)
        v13.*row.feature = VK_TRUE;
}

std::string DeviceFeatures::findMissing() const {
    for (const char* words :
         {findUnset(v13, kRows13), findUnset(v12, kRows12), findUnset(core.features, kCoreRows)})
        if (words)
            return words;
    return {};
}

} // namespace shutter::gpu
