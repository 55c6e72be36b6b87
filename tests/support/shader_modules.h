// SPDX-License-Identifier: MIT
// The shader modules of this build, as they are shipped, and their device requirements.
#pragma once

#include "engine/gpu/device_select.h"
#include "engine/gpu/shader_reflection.h"
#include "engine/gpu/vulkan.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace shutter::test {

struct ShaderModule {
    std::string name; ///< path below the folder of modules: "render/gbuffer.vert"
    std::vector<uint32_t> words;
};

/// All modules below a folder of the build's ("" for all of them).
inline std::vector<ShaderModule>
readShaderModules(const std::filesystem::path& build, const std::string& folder) {
    const std::filesystem::path root = build / "generated/spirv";
    std::vector<ShaderModule> modules;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
        if (entry.path().extension() != ".spv")
            continue;
        ShaderModule module;
        module.name = entry.path().lexically_relative(root).replace_extension().generic_string();
        module.words.resize(entry.file_size() / sizeof(uint32_t));
        std::ifstream file(entry.path(), std::ios::binary);
        file.read(
            reinterpret_cast<char*>(module.words.data()),
            static_cast<std::streamsize>(module.words.size() * sizeof(uint32_t))
        );
        modules.push_back(std::move(module));
    }
    return modules;
}

/// Features that were enabled.
struct EnabledFeatures {
    const VkPhysicalDeviceFeatures& core;
    const VkPhysicalDeviceVulkan12Features& v12;
    const VkPhysicalDeviceVulkan13Features& v13;
    gpu::RayTier rays = gpu::RayTier::None;
};

/// Whether a shader may declare a capability of SPIR-V, by its number.
/// Source: Vulkan 1.3, appendix "Vulkan Environment for SPIR-V", table of capabilities.
inline bool isCapabilityEnabled(const EnabledFeatures& enabled, uint32_t capability) {
    switch (capability) {
    case 1:  // Shader
    case 50: // ImageQuery
        return true;
    case 52: // InterpolationFunction
        return enabled.core.sampleRateShading;
    case 49: // StorageImageExtendedFormats
        return enabled.core.shaderStorageImageExtendedFormats;
    case 5301: // ShaderNonUniform
        return enabled.v12.descriptorIndexing;
    case 5302: // RuntimeDescriptorArray
        return enabled.v12.runtimeDescriptorArray;
    case 5307: // SampledImageArrayNonUniformIndexing
        return enabled.v12.shaderSampledImageArrayNonUniformIndexing;
    case 5347: // PhysicalStorageBufferAddresses
        return enabled.v12.bufferDeviceAddress;
    case 4472: // RayQueryKHR
        return enabled.rays == gpu::RayTier::RayQuery;
    case 4479: // RayTracingKHR
        return enabled.rays == gpu::RayTier::Pipeline;
    default:
        return false;
    }
}

/// What a module needs and the device has not enabled, in words, each with the module's name.
inline std::vector<std::string>
findLacking(const ShaderModule& module, const EnabledFeatures& enabled) {
    const gpu::ShaderNeeds needs = gpu::reflectNeeds(module.words);
    std::vector<std::string> lacking;
    const auto expect = [&](bool has, const std::string& what) {
        if (!has)
            lacking.push_back(module.name + " needs " + what);
    };
    for (const uint32_t capability : needs.capabilities)
        expect(
            isCapabilityEnabled(enabled, capability), "capability " + std::to_string(capability)
        );
    expect(
        !needs.indexesTextures || enabled.core.shaderSampledImageArrayDynamicIndexing,
        "shaderSampledImageArrayDynamicIndexing"
    );
    expect(!needs.terminates || enabled.v13.shaderTerminateInvocation, "shaderTerminateInvocation");
    expect(!needs.hasLocalSizeId || enabled.v13.maintenance4, "maintenance4");
    return lacking;
}

} // namespace shutter::test
