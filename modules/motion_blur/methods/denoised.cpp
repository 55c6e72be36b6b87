// SPDX-License-Identifier: MIT
// Oberberger, Chajdas, Westermann 2022, one frame: rays at random times, filtered along the motion.
#include "spirv/motion_blur/denoise_atrous.comp.h"
#include "spirv/motion_blur/denoise_variance.comp.h"

#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/passes/filter.h"
#include "modules/motion_blur/passes/stochastic_rays.h"
#include "modules/motion_blur/shared_passes.h"
#include "shaders/motion_blur/denoised_shared.h"

#include <fmt/format.h>

#include <array>

namespace shutter::motion_blur {

extern const Method kDenoised;

namespace {

class DenoisedPasses : public MethodPasses {
  public:
    DenoisedPasses(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
        : mRays(device, sceneLayout),
          mVariance(device, {"variance of rays", motion_blur_denoise_variance_comp, 3}),
          mATrous(device, {"denoise", motion_blur_denoise_atrous_comp, 2}) {}

    MotionBlurOutputs
    add(graph::Graph& graph,
        const MotionBlurInputs& inputs,
        const MotionBlurSettings& settings,
        const PassParams& params,
        SharedPasses& shared) override;

  private:
    StochasticRays mRays;
    ScreenFilter mVariance;
    ScreenFilter mATrous;
};

MotionBlurOutputs DenoisedPasses::add(
    graph::Graph& graph,
    const MotionBlurInputs& inputs,
    const MotionBlurSettings& settings,
    const PassParams& resolved,
    SharedPasses& shared
) {
    PassParams params = resolved;
    auto own = params.getMethod<shader::DenoisedParams>();
    own.frame = gpu::splitAddress(inputs.timedRays->frameConstants);
    own.timed = gpu::splitAddress(inputs.timedRays->timedConstants);
    params.setMethod(own);
    const StochasticRaysOutputs rays = mRays.add(graph, *inputs.timedRays, params);
    const TileMotionOutputs tiles = shared.tileMotion.add(graph, rays.motionDepth, params);
    MotionBlurOutputs outputs;
    outputs.views = {{"noisy", rays.color}, {"tile_max", tiles.tiles}, {"tiles", tiles.dominant}};
    outputs.color =
        mVariance.add(graph, std::array{rays.color, rays.motionDepth, tiles.dominant}, params);
    for (uint32_t level = 0; level < settings.filterLevels; ++level) {
        own.stepPx = static_cast<float>(1u << level);
        params.setMethod(own);
        outputs.color = mATrous.add(
            graph,
            std::array{outputs.color, tiles.dominant},
            params,
            fmt::format(", step {}", 1u << level)
        );
    }
    return outputs;
}

void addDenoisedLevels(BudgetLadder& ladder, const MotionBlurSettings& wanted) {
    const uint32_t samples = wanted.sampleCount;
    for (uint32_t rays = samples / 2; rays >= 1; rays /= 2)
        ladder.reduceSamples(rays, double(rays) / samples);
    ladder.changeMethod("gather", "all rays", getMethod("gather").defaultSamples, 0.1 / samples);
    ladder.reduceSamplesInSteps(ladder.next().sampleCount, 0.1 / samples);
}

} // namespace

const Method kDenoised = {
    .name = "denoised",
    .description = "a ray per pixel at a random time, filtered along the motion",
    .publication = "Oberberger, Chajdas, Westermann 2022",
    .rays = RayNeed::Query,
    .sampleUnit = SampleUnit::Rays,
    .defaultSamples = 1,
    .readsRaster = false,
    .readsLens = true,
    .countsBlocks = false,
    .settings =
        {"tileSizePx", "neighbourhoodTiles", "filterLevels", "luminanceSigma", "maxMotionDepth"},
    .views = {"tile_max", "tiles", "noisy"},
    .resolve =
        [](const MotionBlurSettings& settings, PassParams& params) {
            shader::DenoisedParams own{};
            own.luminanceSigma = settings.luminanceSigma;
            params.setMethod(own);
        },
    .addBudgetLevels = addDenoisedLevels,
    .makePasses = [](gpu::Device& device,
                     VkDescriptorSetLayout sceneLayout) -> std::unique_ptr<MethodPasses> {
        return std::make_unique<DenoisedPasses>(device, sceneLayout);
    },
};

} // namespace shutter::motion_blur
