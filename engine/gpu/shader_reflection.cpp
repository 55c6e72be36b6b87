// SPDX-License-Identifier: MIT
#include "engine/gpu/shader_reflection.h"

#include "engine/core/check.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace shutter::gpu {

namespace {

constexpr size_t kHeaderWords = 5;

enum Opcode : uint32_t {
    kCapability = 17,
    kTypeImage = 25,
    kTypeSampledImage = 27,
    kTypeArray = 28,
    kTypeRuntimeArray = 29,
    kTypePointer = 32,
    kConstant = 43,
    kVariable = 59,
    kAccessChain = 65,
    kInBoundsAccessChain = 66,
    kDecorate = 71,
    kExecutionModeId = 331,
    kTerminateInvocation = 4416,
    kTypeAccelerationStructure = 5341,
};

enum Decoration : uint32_t {
    kBinding = 33,
    kDescriptorSet = 34,
};

enum StorageClass : uint32_t {
    kUniform = 2,
    kStorageBuffer = 12,
};

constexpr uint32_t kLocalSizeId = 38; ///< an execution mode

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

/// A type, as far as it matters for descriptors.
struct Type {
    uint32_t opcode = 0;
    uint32_t element = 0;      ///< of arrays and pointers: the element or pointee type
    uint32_t storageClass = 0; ///< of pointers
    bool isStorageImage = false;
    VkFormat format = VK_FORMAT_UNDEFINED; ///< of storage images
};

/// The variables of a module and their decorations, by result id.
struct Module {
    std::map<uint32_t, Type> types;
    std::map<uint32_t, uint32_t> variables;      ///< pointer types
    std::map<uint32_t, uint32_t> bindings;       ///< of variables
    std::map<uint32_t, uint32_t> descriptorSets; ///< of variables
    std::set<uint32_t> constants;
    ShaderNeeds needs;

    /// \param words of one instruction, opcode first
    void read(std::span<const uint32_t> words);
    void readType(uint32_t opcode, std::span<const uint32_t> words);
    void readAccess(std::span<const uint32_t> words);
    /// The type that a variable holds, taken out of arrays.
    [[nodiscard]] const Type* findHeld(uint32_t pointer) const;
};

void Module::readType(uint32_t opcode, std::span<const uint32_t> words) {
    Type type;
    type.opcode = opcode;
    if (opcode == kTypeImage && words.size() >= 9) {
        type.isStorageImage = words[7] == kUsedForStorage;
        if (type.isStorageImage && words[8] < kImageFormats.size())
            type.format = kImageFormats[words[8]];
    } else if (opcode == kTypePointer && words.size() >= 4) {
        type.storageClass = words[2];
        type.element = words[3];
    } else if ((opcode == kTypeArray || opcode == kTypeRuntimeArray) && words.size() >= 3) {
        type.element = words[2];
    }
    types[words[1]] = type;
}

void Module::readAccess(std::span<const uint32_t> words) {
    const auto variable = variables.find(words[3]);
    if (variable == variables.end() || !descriptorSets.contains(words[3]))
        return;
    const Type* held = findHeld(variable->second);
    const bool isTexture =
        held && (held->opcode == kTypeSampledImage || held->opcode == kTypeImage);
    needs.indexesTextures |= isTexture && !constants.contains(words[4]);
}

void Module::read(std::span<const uint32_t> words) {
    const uint32_t opcode = words[0] & 0xffffu;
    const size_t count = words.size();
    switch (opcode) {
    case kTypeImage:
    case kTypeSampledImage:
    case kTypeArray:
    case kTypeRuntimeArray:
    case kTypePointer:
    case kTypeAccelerationStructure:
        if (count >= 2)
            readType(opcode, words);
        break;
    case kVariable:
        if (count >= 4)
            variables[words[2]] = words[1];
        break;
    case kConstant:
        if (count >= 3)
            constants.insert(words[2]);
        break;
    case kDecorate:
        if (count >= 4 && words[2] == kBinding)
            bindings[words[1]] = words[3];
        else if (count >= 4 && words[2] == kDescriptorSet)
            descriptorSets[words[1]] = words[3];
        break;
    case kAccessChain:
    case kInBoundsAccessChain:
        if (count >= 5)
            readAccess(words);
        break;
    case kCapability:
        if (count >= 2)
            needs.capabilities.insert(words[1]);
        break;
    case kExecutionModeId:
        needs.hasLocalSizeId |= count >= 3 && words[2] == kLocalSizeId;
        break;
    case kTerminateInvocation:
        needs.terminates = true;
        break;
    default:
        break;
    }
}

const Type* Module::findHeld(uint32_t pointer) const {
    auto found = types.find(pointer);
    while (found != types.end() &&
           (found->second.opcode == kTypePointer || found->second.opcode == kTypeArray ||
            found->second.opcode == kTypeRuntimeArray)) {
        const auto next = types.find(found->second.element);
        if (next == types.end())
            return nullptr; // a struct: nothing of it is kept
        found = next;
    }
    return found == types.end() ? nullptr : &found->second;
}

Module readModule(std::span<const uint32_t> spirv) {
    SHUTTER_CHECK(
        spirv.size() >= kHeaderWords && spirv[0] == kSpirvMagic,
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

VkDescriptorType describeType(const Module& module, uint32_t pointer) {
    const auto type = module.types.find(pointer);
    if (type == module.types.end())
        return VK_DESCRIPTOR_TYPE_MAX_ENUM;
    if (type->second.storageClass == kUniform)
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    if (type->second.storageClass == kStorageBuffer)
        return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const Type* held = module.findHeld(pointer);
    if (!held)
        return VK_DESCRIPTOR_TYPE_MAX_ENUM;
    switch (held->opcode) {
    case kTypeSampledImage:
        return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case kTypeImage:
        return held->isStorageImage ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                    : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    case kTypeAccelerationStructure:
        return VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
    default:
        return VK_DESCRIPTOR_TYPE_MAX_ENUM;
    }
}

} // namespace

std::vector<ShaderBinding> reflectBindings(std::span<const uint32_t> spirv) {
    const Module module = readModule(spirv);
    std::vector<ShaderBinding> bindings;
    for (const auto& [variable, pointer] : module.variables) {
        const auto set = find(module.descriptorSets, variable);
        const auto binding = find(module.bindings, variable);
        if (!set || !binding)
            continue;
        const Type* held = module.findHeld(pointer);
        const VkFormat format = held ? held->format : VK_FORMAT_UNDEFINED;
        bindings.push_back({*set, *binding, describeType(module, pointer), format});
    }
    std::sort(bindings.begin(), bindings.end(), [](const auto& a, const auto& b) {
        return a.set != b.set ? a.set < b.set : a.binding < b.binding;
    });
    return bindings;
}

std::vector<VkFormat> reflectStorageFormats(std::span<const uint32_t> spirv) {
    std::vector<VkFormat> formats;
    for (const ShaderBinding& binding : reflectBindings(spirv)) {
        if (binding.set != 0 || binding.type != VK_DESCRIPTOR_TYPE_STORAGE_IMAGE)
            continue;
        if (formats.size() <= binding.binding)
            formats.resize(binding.binding + 1, VK_FORMAT_UNDEFINED);
        formats[binding.binding] = binding.format;
    }
    return formats;
}

ShaderNeeds reflectNeeds(std::span<const uint32_t> spirv) {
    return readModule(spirv).needs;
}

core::Status
checkInterface(std::span<const uint32_t> spirv, VkShaderStageFlagBits stage, const PipelineInterface& interface) {
    for (const ShaderBinding& one : reflectBindings(spirv)) {
        const bool isScene = one.set == 1 && interface.sceneLayout != VK_NULL_HANDLE;
        if (one.set > 0 && !isScene)
            return core::makeError(
                "the shader names set {}, which the layout does not have", one.set
            );
        if (isScene && (stage & kSceneStages) == 0)
            return core::makeError("the shader's stage does not see set 1, which it names");
        if (isScene)
            continue;
        if (one.binding >= interface.bindings.size())
            return core::makeError(
                "the shader names binding {}, the layout has {}",
                one.binding,
                interface.bindings.size()
            );
        if (one.type != interface.bindings[one.binding])
            return core::makeError(
                "binding {} is of type {} in the shader and {} in the layout",
                one.binding,
                static_cast<int>(one.type),
                static_cast<int>(interface.bindings[one.binding])
            );
    }
    return {};
}

} // namespace shutter::gpu
