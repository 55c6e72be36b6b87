// SPDX-License-Identifier: MIT
// Shader modules as they are shipped, and modules written down word by word: what they name, and
// laws about every one that is built.
#include "engine/gpu/device_features.h"
#include "engine/gpu/shader_reflection.h"
#include "tests/support/shader_modules.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <iterator>
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

TEST(ShaderReflection, TheFormatAtEachBindingIsFoundAndWhatIsNoStorageImageHasNone) {
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
    // Textures, a structure of rays, images, and the scene's set.
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
    std::vector<uint32_t> words = {0x07230203, 0x00010600, 0, 10, 0}; // header
    const auto add = [&](uint32_t opcode, std::initializer_list<uint32_t> operands) {
        words.push_back(uint32_t(operands.size() + 1) << 16u | opcode);
        words.insert(words.end(), operands);
    };
    add(71, {4, 34, declared.set});                                 // OpDecorate %4 DescriptorSet
    add(71, {4, 33, declared.binding});                             // OpDecorate %4 Binding
    add(22, {1, 32});                                               // %1 = OpTypeFloat 32
    add(25, {2, 1, 1, 0, 0, 0, declared.sampled, declared.format}); // %2 = OpTypeImage
    add(32, {3, 0, 2});                                             // %3 = OpTypePointer
    add(59, {3, 4, 0});                                             // %4 = OpVariable
    return words;
}

TEST(ShaderReflection, FormatsAreThoseOfDeclaredStorageImagesOfTheFirstSet) {
    EXPECT_EQ(
        reflectStorageFormats(makeModule({})), (Formats{kNone, VK_FORMAT_R16G16B16A16_SFLOAT})
    );
    EXPECT_EQ(reflectStorageFormats(makeModule({.sampled = 1})), Formats{});
    EXPECT_EQ(reflectStorageFormats(makeModule({.set = 1})), Formats{});
    EXPECT_EQ(reflectStorageFormats(makeModule({.format = 0})), (Formats{kNone, kNone}));
    // The last numbers of SPIR-V.
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

TEST(ShaderInterface, AllThatAModuleNamesMustBeBoundAndSeenByItsStage) {
    constexpr auto kComputing = VK_SHADER_STAGE_COMPUTE_BIT;
    constexpr auto kShading = VK_SHADER_STAGE_FRAGMENT_BIT;

    const struct {
        Declared declared;
        VkShaderStageFlagBits stage;
        PipelineInterface interface;
        const char* sentence;
    } cases[] = {
        {{}, kComputing, makeInterface({kTexture, kStorage}), ""},
        {{}, kComputing, makeInterface({kTexture}), "the shader names binding 1, the layout has 1"},
        {{},
         kComputing,
         makeInterface({kTexture, kTexture}),
         "binding 1 is of type 3 in the shader and 1 in the layout"},
        {{.set = 1}, kShading, makeInterface({}, true), ""},
        {{.set = 1},
         kShading,
         makeInterface({}),
         "the shader names set 1, which the layout does not have"},
        {{.set = 1},
         VK_SHADER_STAGE_VERTEX_BIT,
         makeInterface({}, true),
         "the shader's stage does not see set 1, which it names"}};

    for (const auto& [declared, stage, interface, sentence] : cases) {
        const core::Status status = checkInterface(makeModule(declared), stage, interface);
        EXPECT_EQ(status.ok() ? "" : status.error().message, sentence);
    }
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

std::vector<test::ShaderModule> readAll() {
    auto modules = test::readShaderModules(SHUTTER_BUILD_DIR, "");
    EXPECT_GT(modules.size(), 40u) << "are the modules elsewhere?";
    return modules;
}

/// The tier that a module is written for; no module traces rays in both ways.
RayTier tierOf(const test::ShaderModule& module) {
    const auto needs = reflectNeeds(module.words);
    return needs.capabilities.contains(4479) ? RayTier::Pipeline : RayTier::RayQuery;
}

TEST(ShaderModules, AllModulesUseOnlyEnabledFeatures) {
    DeviceFeatures features;
    features.enableNeeded();
    // Enabled where there is one: without it a raster has one sample per pixel.
    features.core.features.sampleRateShading = VK_TRUE;
    for (const auto& module : readAll())
        for (const std::string& lacking : test::findLacking(
                 module, {features.core.features, features.v12, features.v13, tierOf(module)}
             ))
            ADD_FAILURE() << lacking;
}

TEST(ShaderModules, MissingFeaturesAreFound) {
    DeviceFeatures features;
    EXPECT_FALSE(features.findMissing().empty());
    features.enableNeeded();
    EXPECT_EQ(features.findMissing(), "");
    features.v13.shaderTerminateInvocation = VK_FALSE;
    EXPECT_EQ(features.findMissing(), "terminating invocations");
    features.enableNeeded();
    features.core.features.shaderSampledImageArrayDynamicIndexing = VK_FALSE;
    EXPECT_EQ(features.findMissing(), "dynamic indexing of textures");
    features.v13.shaderTerminateInvocation = VK_FALSE;
    const test::ShaderModule fragment{
        "render/gbuffer.frag", {std::begin(render_gbuffer_frag), std::end(render_gbuffer_frag)}};
    EXPECT_EQ(
        test::findLacking(
            fragment, {features.core.features, features.v12, features.v13, RayTier::None}
        ),
        (std::vector<std::string>{
            "render/gbuffer.frag needs shaderSampledImageArrayDynamicIndexing",
            "render/gbuffer.frag needs shaderTerminateInvocation"})
    );
}

TEST(ShaderModules, TheScenesTexturesAreNamedOnlyInStagesThatSeeThem) {
    for (const auto& module : readAll())
        for (const ShaderBinding& binding : reflectBindings(module.words)) {
            EXPECT_NE(binding.type, VK_DESCRIPTOR_TYPE_MAX_ENUM) << module.name;
            EXPECT_LE(binding.set, 1u) << module.name;
            const bool seesNone = module.name.ends_with(".vert") ||
                                  module.name.ends_with(".rmiss") ||
                                  module.name.ends_with(".rchit");
            EXPECT_FALSE(binding.set == 1 && seesNone) << module.name;
        }
}

} // namespace
} // namespace shutter::gpu
