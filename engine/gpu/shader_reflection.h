// SPDX-License-Identifier: MIT
// Reflection of a shader module. The words must be SPIR-V (CHECKed). Source: SPIR-V 1.6, physical
// layout of a module, image formats, instructions.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <set>
#include <span>
#include <vector>

namespace shutter::gpu {

/// First word of every module.
inline constexpr uint32_t kSpirvMagic = 0x07230203;

/// A variable of a module that is bound by a descriptor. Vulkan holds every one that a module lists
/// in its interface to be used, whether an instruction touches it or not.
struct ShaderBinding {
    uint32_t set = 0;
    uint32_t binding = 0;
    /// VK_DESCRIPTOR_TYPE_MAX_ENUM: a kind that this engine does not bind.
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_MAX_ENUM;
    VkFormat format = VK_FORMAT_UNDEFINED; ///< declared, of storage images

    bool operator==(const ShaderBinding&) const = default;
};

/// By set, then by binding.
[[nodiscard]] std::vector<ShaderBinding> reflectBindings(std::span<const uint32_t> spirv);

/// The formats that a shader declares for its storage images in descriptor set 0: element i is
/// binding i's, VK_FORMAT_UNDEFINED where that is not a storage image or has no declared format. No
/// element follows the last storage image. Vulkan leaves values undefined where the declared format
/// is not that of the image bound there, and older validation layers do not report it.
[[nodiscard]] std::vector<VkFormat> reflectStorageFormats(std::span<const uint32_t> spirv);

/// Device requirements of a module, beyond Vulkan 1.0 without features.
struct ShaderNeeds {
    std::set<uint32_t> capabilities; ///< SPIR-V's numbers, as declared
    bool indexesTextures = false;    ///< indexes arrays of textures by non-constant values
    bool terminates = false;         ///< has OpTerminateInvocation
    bool hasLocalSizeId = false;     ///< gives its workgroup's size by constants
};

[[nodiscard]] ShaderNeeds reflectNeeds(std::span<const uint32_t> spirv);

/// Checks that the pipeline's layout has every binding of the shader, visible to its stage. Error:
/// a sentence that names the missing binding.
[[nodiscard]] core::Status
checkInterface(std::span<const uint32_t> spirv, VkShaderStageFlagBits stage, const PipelineInterface& interface);

} // namespace shutter::gpu
