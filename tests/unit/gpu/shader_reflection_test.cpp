// SPDX-License-Identifier: MIT
// The storage formats of shaders as they are shipped, and of modules written down word by word.
#include "engine/gpu/shader_reflection.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

// clang-format off: need <cstdint> before them
#include "spirv/accumulate/accumulate.comp.h"
#include "spirv/motion_blur/edge.comp.h"
#include "spirv/motion_blur/reveal.comp.h"
#include "spirv/motion_blur/reveal_sky.comp.h"
#include "spirv/motion_blur/tile_max.comp.h"
#include "spirv/render/gbuffer.frag.h"
#include "spirv/render/gbuffer.vert.h"

// clang-format on

namespace shutter::gpu {
namespace {

using Formats = std::vector<VkFormat>;

constexpr VkFormat kNone = VK_FORMAT_UNDEFINED;

TEST(ShaderReflection, TheFormatAtEachBindingIsFound) {
    EXPECT_EQ(
        reflectStorageFormats(accumulate_accumulate_comp),
        (Formats{kNone, VK_FORMAT_R32G32B32A32_SFLOAT})
    );
    EXPECT_EQ(
        reflectStorageFormats(motion_blur_tile_max_comp),
        (Formats{kNone, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT})
    );
    EXPECT_EQ(
        reflectStorageFormats(motion_blur_edge_comp),
        (Formats{kNone, kNone, kNone, VK_FORMAT_R8_UNORM, VK_FORMAT_R8_UNORM})
    );
}

TEST(ShaderReflection, BuffersStructuresAndTheScenesSetAreOmitted) {
    EXPECT_EQ(
        reflectStorageFormats(motion_blur_reveal_comp),
        (Formats{
            kNone,
            kNone,
            kNone,
            kNone,
            VK_FORMAT_R16G16B16A16_SFLOAT,
            VK_FORMAT_R32G32B32A32_SFLOAT,
            VK_FORMAT_R32_UINT})
    );
}

/// A module of one image variable.
struct Declared {
    uint32_t sampled = 2; ///< 1 with a sampler, 2 for stores
    uint32_t format = 2;  ///< SPIR-V's number; 2: Rgba16f
    uint32_t set = 0;
    uint32_t binding = 1;
};

std::vector<uint32_t> makeModule(const Declared& declared) {
    const auto head = [](uint32_t words, uint32_t opcode) { return words << 16u | opcode; };
    return {
        0x07230203,
        0x00010600,
        0,
        10,
        0, // header
        head(4, 71),
        4,
        34,
        declared.set, // OpDecorate %4 DescriptorSet
        head(4, 71),
        4,
        33,
        declared.binding, // OpDecorate %4 Binding
        head(3, 22),
        1,
        32, // %1 = OpTypeFloat 32
        head(9, 25),
        2,
        1,
        1,
        0,
        0,
        0,
        declared.sampled,
        declared.format, // %2 = OpTypeImage
        head(4, 32),
        3,
        0,
        2, // %3 = OpTypePointer
        head(4, 59),
        3,
        4,
        0, // %4 = OpVariable
    };
}

TEST(ShaderReflection, ASampledImageAndOneOfAnotherSetHaveNone) {
    EXPECT_EQ(
        reflectStorageFormats(makeModule({})), (Formats{kNone, VK_FORMAT_R16G16B16A16_SFLOAT})
    );
    EXPECT_EQ(reflectStorageFormats(makeModule({.sampled = 1})), Formats{});
    EXPECT_EQ(reflectStorageFormats(makeModule({.set = 1})), Formats{});
}

TEST(ShaderReflection, AnImageDeclaredWithoutAFormatHasNone) {
    EXPECT_EQ(reflectStorageFormats(makeModule({.format = 0})), (Formats{kNone, kNone}));
}

TEST(ShaderReflection, TheLastFormatsOfSpirvAreTranslated) {
    EXPECT_EQ(
        reflectStorageFormats(makeModule({.format = 39, .binding = 0})), Formats{VK_FORMAT_R8_UINT}
    );
    EXPECT_EQ(
        reflectStorageFormats(makeModule({.format = 41, .binding = 0})), Formats{VK_FORMAT_R64_SINT}
    );
}

constexpr VkDescriptorType kTexture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

/// An interface of these bindings, with or without a layout for set 1.
PipelineInterface makeInterface(std::vector<VkDescriptorType> bindings, bool hasScene = false) {
    PipelineInterface interface;
    interface.bindings = std::move(bindings);
    if (hasScene)
        interface.sceneLayout = reinterpret_cast<VkDescriptorSetLayout>(uintptr_t(1));
    return interface;
}

std::string
checkMade(const Declared& declared, VkShaderStageFlagBits stage, const PipelineInterface& interface) {
    const core::Status status = checkInterface(makeModule(declared), stage, interface);
    return status.ok() ? "" : status.error().message;
}

TEST(ShaderInterface, AllBindingsOfAModuleMustBeBound) {
    constexpr auto kCompute = VK_SHADER_STAGE_COMPUTE_BIT;
    EXPECT_EQ(checkMade({}, kCompute, makeInterface({kTexture, kStorage})), "");
    EXPECT_EQ(
        checkMade({}, kCompute, makeInterface({kTexture})),
        "the shader names binding 1, the layout has 1"
    );
    EXPECT_EQ(
        checkMade({}, kCompute, makeInterface({kTexture, kTexture})),
        "binding 1 is of type 3 in the shader and 1 in the layout"
    );
}

TEST(ShaderInterface, SetOneMustBeThereAndSeenByTheStage) {
    const Declared scene{.set = 1};
    EXPECT_EQ(checkMade(scene, VK_SHADER_STAGE_FRAGMENT_BIT, makeInterface({}, true)), "");
    EXPECT_EQ(
        checkMade(scene, VK_SHADER_STAGE_FRAGMENT_BIT, makeInterface({})),
        "the shader names set 1, which the layout does not have"
    );
    EXPECT_EQ(
        checkMade(scene, VK_SHADER_STAGE_VERTEX_BIT, makeInterface({}, true)),
        "the shader's stage does not see set 1, which it names"
    );
}

TEST(ShaderInterface, ModulesDoNotNameTheSceneTexturesTheyLeaveAlone) {
    EXPECT_TRUE(reflectBindings(render_gbuffer_vert).empty());
    EXPECT_EQ(
        reflectBindings(render_gbuffer_frag),
        (std::vector<ShaderBinding>{{1, 0, kTexture, VK_FORMAT_UNDEFINED}})
    );
    for (const ShaderBinding& binding : reflectBindings(motion_blur_reveal_sky_comp))
        EXPECT_EQ(binding.set, 0u);
}

TEST(ShaderReflectionDeathTest, InvalidOrTruncatedSpirvIsRefused) {
    std::vector<uint32_t> words = makeModule({});
    words.pop_back();
    EXPECT_DEATH((void)reflectStorageFormats(words), "claims 4 words");
    words[0] = 0;
    EXPECT_DEATH((void)reflectStorageFormats(words), "no SPIR-V");
    EXPECT_DEATH((void)reflectStorageFormats({}), "0 words that are no SPIR-V");
}

} // namespace
} // namespace shutter::gpu
