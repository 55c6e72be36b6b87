// SPDX-License-Identifier: MIT
// Tan, Cui, Bhojan, "Hybrid MBlur": the post-process, of the raster layer alone.
#include "modules/motion_blur/passes/gather.h"

#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/shared_passes.h"
#include "shaders/motion_blur/gather_shared.h"

namespace shutter::motion_blur {

extern const Method kGather;

namespace {

class GatherPasses : public BlockMethod {
  public:
    explicit GatherPasses(gpu::Device& device) : mGather(device) {}

  protected:
    graph::ImageHandle filter(
        graph::Graph& graph,
        const BlockInputs& inputs,
        graph::ImageHandle target,
        const PassParams& params,
        std::vector<View>& /*views*/
    ) const override {
        return mGather.add(
            graph,
            {inputs.frame.color, inputs.frame.motionDepth, inputs.tiles.dominant, {}},
            inputs.blocks,
            target,
            params
        );
    }

  private:
    Gather mGather;
};

} // namespace

const Method kGather = {
    .name = "gather",
    .description = "gather along dominant motion (the paper's post-process)",
    .publication = "Tan, Cui, Bhojan, Hybrid MBlur, post-process",
    .usesUniformMotion = true,
    .settings =
        {"tileSizePx",
         "neighbourhoodTiles",
         "softDepthExtent",
         "softDepthShare",
         "jitter",
         "maxMotionDepth",
         "foregroundMagnification",
         "uniformMotionPx",
         "halfResolutionPx"},
    .views = {"tile_max", "tiles", "cost"},
    .resolve =
        [](const MotionBlurSettings& settings, PassParams& params) {
            params.setMethod(shader::GatherParams{
                settings.foregroundMagnification, 1.0f, settings.halfResolutionPx, 0.0f});
        },
    .addBudgetLevels =
        [](BudgetLadder& ladder, const MotionBlurSettings& wanted) {
            ladder.halveResolution(0.9);
            ladder.reduceSamplesInSteps(wanted.sampleCount, 0.9);
        },
    .makePasses = [](gpu::Device& device, VkDescriptorSetLayout) -> std::unique_ptr<MethodPasses> {
        return std::make_unique<GatherPasses>(device);
    },
};

} // namespace shutter::motion_blur
