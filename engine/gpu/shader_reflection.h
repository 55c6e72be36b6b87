// SPDX-License-Identifier: MIT
// What a compiled shader says about the images it stores to. Vulkan leaves values undefined where
// the format that a shader declares is not the format of the image bound there, and older
// validation layers do not see it.
#pragma once

#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::gpu {

/// The formats that a shader declares for its storage images in descriptor set 0: element i is
/// binding i's, VK_FORMAT_UNDEFINED where that is no storage image or is declared without a format.
/// No element follows the last storage image. The words must be SPIR-V (CHECKed).
/// Source: SPIR-V 1.6, physical layout of a module, image formats, instructions.
[[nodiscard]] std::vector<VkFormat> reflectStorageFormats(std::span<const uint32_t> spirv);

} // namespace shutter::gpu
