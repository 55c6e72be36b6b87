// SPDX-License-Identifier: MIT
// The mean of samples along each pixel's own motion.
#include "spirv/motion_blur/own_velocity.comp.h"

#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/shared_passes.h"
#include "shaders/motion_blur/own_velocity_shared.h"

namespace shutter::motion_blur {

extern const Method kOwnVelocity;

const Method kOwnVelocity = {
    .name = "own_velocity",
    .description = "mean of samples along each pixel's own motion",
    .publication = "three.js, Babylon.js; Bevy with occluderTest=velocity",
    .defaultSamples = 16,
    .settings = {"jitter", "occluderTest", "maxMotionDepth"},
    .views = {"cost"},
    .resolve =
        [](const MotionBlurSettings& settings, PassParams& params) {
            // No neighbour's motion comes over a pixel.
            params.neighbourRadius = 0;
            params.setMethod(shader::OwnVelocityParams{
                settings.occluderTest == OccluderTest::Velocity ? 1u : 0u});
        },
    .addBudgetLevels = addSampleLevels,
    .makePasses =
        [](gpu::Device& device, VkDescriptorSetLayout) {
            return makeOnePassMethod(
                device, "own velocity", motion_blur_own_velocity_comp, DominantMotion::Unused
            );
        },
};

} // namespace shutter::motion_blur
