// SPDX-License-Identifier: MIT
// Jimenez 2014, "Next Generation Post Processing in Call of Duty: Advanced Warfare".
#include "spirv/motion_blur/jimenez2014.comp.h"

#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/shared_passes.h"

#include <algorithm>

namespace shutter::motion_blur {

extern const Method kJimenez2014;

const Method kJimenez2014 = {
    .name = "jimenez2014",
    .description = "scatter as you gather, mirrored weights",
    .publication = "Jimenez 2014",
    .defaultSamples = 8,
    .settings =
        {"tileSizePx",
         "neighbourhoodTiles",
         "softDepthExtent",
         "softDepthShare",
         "jitter",
         "maxMotionDepth"},
    .views = {"tile_max", "tiles", "cost"},
    .resolve =
        [](const MotionBlurSettings& settings, PassParams& params) {
            // A smear fades over one tap's distance beyond its end.
            const float tapPx =
                static_cast<float>(params.tileSizePx) / static_cast<float>(settings.sampleCount);
            params.marginPx = std::max(measureTileJitter(params), tapPx);
        },
    .addBudgetLevels = addSampleLevels,
    .makePasses =
        [](gpu::Device& device, VkDescriptorSetLayout) {
            return makeOnePassMethod(
                device, "jimenez2014", motion_blur_jimenez2014_comp, DominantMotion::Read
            );
        },
};

} // namespace shutter::motion_blur
