// SPDX-License-Identifier: MIT
// McGuire, Hennessy, Bukowski, Osman 2012, "A Reconstruction Filter for Plausible Motion Blur".
#include "spirv/motion_blur/mcguire2012.comp.h"

#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/shared_passes.h"

namespace shutter::motion_blur {

extern const Method kMcGuire2012;

const Method kMcGuire2012 = {
    .name = "mcguire2012",
    .description = "gather along dominant motion, soft depth test",
    .publication = "McGuire, Hennessy, Bukowski, Osman 2012",
    .settings =
        {"tileSizePx",
         "neighbourhoodTiles",
         "softDepthExtent",
         "softDepthShare",
         "jitter",
         "maxMotionDepth"},
    .views = {"tile_max", "tiles", "cost"},
    .addBudgetLevels = addSampleLevels,
    .makePasses =
        [](gpu::Device& device, VkDescriptorSetLayout) {
            return makeOnePassMethod(
                device, "mcguire2012", motion_blur_mcguire2012_comp, DominantMotion::Read
            );
        },
};

} // namespace shutter::motion_blur
