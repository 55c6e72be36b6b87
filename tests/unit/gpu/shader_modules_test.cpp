// SPDX-License-Identifier: MIT
// Laws about every shader module that is built, read as it is shipped.
#include "engine/gpu/device_features.h"
#include "engine/gpu/shader_reflection.h"
#include "tests/support/shader_modules.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace shutter {
namespace {

using gpu::RayTier;

std::vector<test::ShaderModule> readAll() {
    auto modules = test::readShaderModules(SHUTTER_BUILD_DIR, "");
    EXPECT_GT(modules.size(), 40u) << "are the modules elsewhere?";
    return modules;
}

/// The tier that a module is written for; no module traces rays in both ways.
RayTier tierOf(const test::ShaderModule& module) {
    const auto needs = gpu::reflectNeeds(module.words);
    return needs.capabilities.contains(4479) ? RayTier::Pipeline : RayTier::RayQuery;
}

TEST(ShaderModules, AllModulesUseOnlyEnabledFeatures) {
    gpu::DeviceFeatures features;
    features.enableNeeded();
    for (const auto& module : readAll())
        for (const std::string& lacking : test::findLacking(
                 module, {features.core.features, features.v12, features.v13, tierOf(module)}
             ))
            ADD_FAILURE() << lacking;
}

TEST(ShaderModules, MissingFeaturesAreFound) {
    gpu::DeviceFeatures features;
    features.enableNeeded();
    features.core.features.shaderSampledImageArrayDynamicIndexing = VK_FALSE;
    features.v13.shaderTerminateInvocation = VK_FALSE;
    const auto modules = readAll();
    const auto fragment = std::find_if(modules.begin(), modules.end(), [](const auto& module) {
        return module.name == "render/gbuffer.frag";
    });
    ASSERT_NE(fragment, modules.end());
    EXPECT_EQ(
        test::findLacking(
            *fragment, {features.core.features, features.v12, features.v13, RayTier::None}
        ),
        (std::vector<std::string>{
            "render/gbuffer.frag needs shaderSampledImageArrayDynamicIndexing",
            "render/gbuffer.frag needs shaderTerminateInvocation"})
    );
}

TEST(ShaderModules, TheScenesTexturesAreNamedOnlyInStagesThatSeeThem) {
    for (const auto& module : readAll())
        for (const gpu::ShaderBinding& binding : gpu::reflectBindings(module.words)) {
            EXPECT_NE(binding.type, VK_DESCRIPTOR_TYPE_MAX_ENUM) << module.name;
            EXPECT_LE(binding.set, 1u) << module.name;
            const bool seesNone = module.name.ends_with(".vert") ||
                                  module.name.ends_with(".rmiss") ||
                                  module.name.ends_with(".rchit");
            EXPECT_FALSE(binding.set == 1 && seesNone) << module.name;
        }
}

TEST(DeviceFeatures, OnlyRequiredFeaturesAreEnabled) {
    gpu::DeviceFeatures features;
    EXPECT_FALSE(features.findMissing().empty());
    features.enableNeeded();
    EXPECT_EQ(features.findMissing(), "");
    features.v13.shaderTerminateInvocation = VK_FALSE;
    EXPECT_EQ(features.findMissing(), "terminating invocations");
    features.enableNeeded();
    features.core.features.shaderSampledImageArrayDynamicIndexing = VK_FALSE;
    EXPECT_EQ(features.findMissing(), "dynamic indexing of textures");
}

} // namespace
} // namespace shutter
