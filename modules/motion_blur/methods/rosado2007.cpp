// SPDX-License-Identifier: MIT
// Rosado 2007, "Motion Blur as a Post-Processing Effect", GPU Gems 3, chapter 27: the mean of
// samples along camera motion, computed from depth. Moving objects are treated as static.
#include "spirv/motion_blur/own_velocity.comp.h"
#include "spirv/motion_blur/rosado2007.comp.h"

#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/passes/filter.h"
#include "modules/motion_blur/shared_passes.h"
#include "shaders/motion_blur/own_velocity_shared.h"

#include <array>

namespace shutter::motion_blur {

extern const Method kRosado2007;

namespace {

class RosadoPasses : public MethodPasses {
  public:
    explicit RosadoPasses(gpu::Device& device)
        : mCameraMotion(device, {"camera motion", motion_blur_rosado2007_comp, 1}),
          mFilter(makeOnePassMethod(
              device, "rosado2007", motion_blur_own_velocity_comp, DominantMotion::Unused
          )) {}

    MotionBlurOutputs
    add(graph::Graph& graph,
        const MotionBlurInputs& inputs,
        const MotionBlurSettings& settings,
        const PassParams& resolved,
        SharedPasses& shared) override {
        PassParams params = resolved;
        MotionBlurInputs own = inputs;
        if (!inputs.motionIsCameras) {
            params.setMethod(gpu::splitAddress(inputs.rays->frameConstants));
            own.motionDepth = mCameraMotion.add(graph, std::array{inputs.motionDepth}, params);
        }
        params.setMethod(shader::OwnVelocityParams{0});
        return mFilter->add(graph, own, settings, params, shared);
    }

  private:
    ScreenFilter mCameraMotion;
    std::unique_ptr<MethodPasses> mFilter;
};

} // namespace

const Method kRosado2007 = {
    .name = "rosado2007",
    .description = "mean of samples along the camera's motion, from depth",
    .publication = "Rosado 2007, GPU Gems 3, chapter 27",
    .defaultSamples = 16,
    .readsCamera = true,
    .blursObjects = false,
    .settings = {"jitter", "maxMotionDepth"},
    .views = {"cost"},
    .resolve =
        [](const MotionBlurSettings&, PassParams& params) {
            params.neighbourRadius = 0; // no neighbour's motion comes over a pixel
        },
    .addBudgetLevels = addSampleLevels,
    .makePasses = [](gpu::Device& device, VkDescriptorSetLayout) -> std::unique_ptr<MethodPasses> {
        return std::make_unique<RosadoPasses>(device);
    },
};

} // namespace shutter::motion_blur
