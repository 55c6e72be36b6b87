// SPDX-License-Identifier: MIT
#include "engine/core/check.h"
#include "engine/gpu/pipeline.h"

#include <array>
#include <map>
#include <optional>

namespace shutter::gpu {

namespace {

constexpr uint32_t kMagic = 0x07230203;
constexpr size_t kHeaderWords = 5;

enum Opcode : uint32_t {
    kTypeImage = 25,
    kTypePointer = 32,
    kVariable = 59,
    kDecorate = 71,
};

enum Decoration : uint32_t {
    kBinding = 33,
    kDescriptorSet = 34,
};

/// "Sampled" of an image type: 1 with a sampler, 2 for loads and stores.
constexpr uint32_t kUsedForStorage = 2;

/// Vulkan's formats in the order in which SPIR-V numbers its own: Unknown, Rgba32f, Rgba16f, ...
constexpr std::array kImageFormats = {
    VK_FORMAT_UNDEFINED,
    VK_FORMAT_R32G32B32A32_SFLOAT,
    VK_FORMAT_R16G16B16A16_SFLOAT,
    VK_FORMAT_R32_SFLOAT,
    VK_FORMAT_R8G8B8A8_UNORM,
    VK_FORMAT_R8G8B8A8_SNORM,
    VK_FORMAT_R32G32_SFLOAT,
    VK_FORMAT_R16G16_SFLOAT,
    VK_FORMAT_B10G11R11_UFLOAT_PACK32,
    VK_FORMAT_R16_SFLOAT,
    VK_FORMAT_R16G16B16A16_UNORM,
    VK_FORMAT_A2B10G10R10_UNORM_PACK32,
    VK_FORMAT_R16G16_UNORM,
    VK_FORMAT_R8G8_UNORM,
    VK_FORMAT_R16_UNORM,
    VK_FORMAT_R8_UNORM,
    VK_FORMAT_R16G16B16A16_SNORM,
    VK_FORMAT_R16G16_SNORM,
    VK_FORMAT_R8G8_SNORM,
    VK_FORMAT_R16_SNORM,
    VK_FORMAT_R8_SNORM,
    VK_FORMAT_R32G32B32A32_SINT,
    VK_FORMAT_R16G16B16A16_SINT,
    VK_FORMAT_R8G8B8A8_SINT,
    VK_FORMAT_R32_SINT,
    VK_FORMAT_R32G32_SINT,
    VK_FORMAT_R16G16_SINT,
    VK_FORMAT_R8G8_SINT,
    VK_FORMAT_R16_SINT,
    VK_FORMAT_R8_SINT,
    VK_FORMAT_R32G32B32A32_UINT,
    VK_FORMAT_R16G16B16A16_UINT,
    VK_FORMAT_R8G8B8A8_UINT,
    VK_FORMAT_R32_UINT,
    VK_FORMAT_A2B10G10R10_UINT_PACK32,
    VK_FORMAT_R32G32_UINT,
    VK_FORMAT_R16G16_UINT,
    VK_FORMAT_R8G8_UINT,
    VK_FORMAT_R16_UINT,
    VK_FORMAT_R8_UINT,
    VK_FORMAT_R64_UINT,
    VK_FORMAT_R64_SINT,
};

/// What the instructions of a module say about its variables, by result id.
struct Module {
    std::map<uint32_t, VkFormat> storageImages;  ///< types
    std::map<uint32_t, uint32_t> pointees;       ///< of pointer types
    std::map<uint32_t, uint32_t> variables;      ///< pointer types
    std::map<uint32_t, uint32_t> bindings;       ///< of variables
    std::map<uint32_t, uint32_t> descriptorSets; ///< of variables

    /// \param words of one instruction, opcode first
    void read(std::span<const uint32_t> words);
};

void Module::read(std::span<const uint32_t> words) {
    const uint32_t opcode = words[0] & 0xffffu;
    if (opcode == kTypeImage && words.size() >= 9 && words[7] == kUsedForStorage)
        storageImages[words[1]] =
            words[8] < kImageFormats.size() ? kImageFormats[words[8]] : VK_FORMAT_UNDEFINED;
    else if (opcode == kTypePointer && words.size() >= 4)
        pointees[words[1]] = words[3];
    else if (opcode == kVariable && words.size() >= 4)
        variables[words[2]] = words[1];
    else if (opcode == kDecorate && words.size() >= 4 && words[2] == kBinding)
        bindings[words[1]] = words[3];
    else if (opcode == kDecorate && words.size() >= 4 && words[2] == kDescriptorSet)
        descriptorSets[words[1]] = words[3];
}

Module readModule(std::span<const uint32_t> spirv) {
    SHUTTER_CHECK(
        spirv.size() >= kHeaderWords && spirv[0] == kMagic,
        "{} words that are no SPIR-V",
        spirv.size()
    );
    Module module;
    for (size_t i = kHeaderWords; i < spirv.size();) {
        const size_t wordCount = spirv[i] >> 16u;
        SHUTTER_CHECK(
            wordCount > 0 && wordCount <= spirv.size() - i,
            "the SPIR-V instruction at word {} of {} claims {} words",
            i,
            spirv.size(),
            wordCount
        );
        module.read(spirv.subspan(i, wordCount));
        i += wordCount;
    }
    return module;
}

std::optional<uint32_t> find(const std::map<uint32_t, uint32_t>& values, uint32_t id) {
    const auto found = values.find(id);
    return found == values.end() ? std::nullopt : std::optional(found->second);
}

} // namespace

std::vector<VkFormat> reflectStorageFormats(std::span<const uint32_t> spirv) {
    const Module module = readModule(spirv);
    std::vector<VkFormat> formats;
    for (const auto& [variable, pointer] : module.variables) {
        const auto binding = find(module.bindings, variable);
        const auto pointee = find(module.pointees, pointer);
        if (!binding || !pointee || find(module.descriptorSets, variable) != 0u)
            continue;
        const auto image = module.storageImages.find(*pointee);
        if (image == module.storageImages.end())
            continue;
        if (formats.size() <= *binding)
            formats.resize(*binding + 1, VK_FORMAT_UNDEFINED);
        formats[*binding] = image->second;
    }
    return formats;
}

} // namespace shutter::gpu
