// SPDX-License-Identifier: MIT
// What hosts are told to enable, against what the effect's shaders need.
#include "modules/motion_blur/embedding/host_features.h"
#include "tests/support/shader_modules.h"

#include <gtest/gtest.h>

#include <string>

namespace shutter::motion_blur {
namespace {

using gpu::RayTier;

constexpr uint32_t kRuntimeDescriptorArray = 5302; // the scene's textures

TEST(HostFeatures, BringWhatTheShadersOfEachTierNeed) {
    const HostFeatures none(RayTier::None);
    const HostFeatures query(RayTier::RayQuery);
    const HostFeatures pipeline(RayTier::Pipeline);
    size_t counts[3] = {};
    for (const auto& module : test::readShaderModules(SHUTTER_BUILD_DIR, "motion_blur")) {
        const auto capabilities = gpu::reflectNeeds(module.words).capabilities;
        RayTier tier = RayTier::None;
        if (capabilities.contains(4479))
            tier = RayTier::Pipeline;
        else if (capabilities.contains(4472) || capabilities.contains(kRuntimeDescriptorArray))
            tier = RayTier::RayQuery;
        const HostFeatures& host = tier == RayTier::None       ? none
                                   : tier == RayTier::RayQuery ? query
                                                               : pipeline;
        ++counts[static_cast<size_t>(tier)];
        for (const std::string& lacking :
             test::findLacking(module, {host.features.features, host.v12, host.v13, tier}))
            ADD_FAILURE() << lacking;
    }
    for (const size_t count : counts)
        EXPECT_GT(count, 2u) << "a tier without shaders proves nothing";
}

} // namespace
} // namespace shutter::motion_blur
