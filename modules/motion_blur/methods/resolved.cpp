// SPDX-License-Identifier: MIT
// Looks up the sample of each pixel at each instant, by the entities' motion, in this frame's
// raster and the last one's.
#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/passes/instant_surfaces.h"
#include "modules/motion_blur/passes/lens_discs.h"
#include "modules/motion_blur/passes/resolve_pass.h"
#include "modules/motion_blur/shared_passes.h"

namespace shutter::motion_blur {

extern const Method kResolved;

namespace {

class ResolvedPasses : public MethodPasses {
  public:
    explicit ResolvedPasses(gpu::Device& device)
        : mResolvePass(device, false), mSurfaces(device), mDiscs(device) {}

    MotionBlurOutputs
    add(graph::Graph& graph,
        const MotionBlurInputs& inputs,
        const MotionBlurSettings& settings,
        const PassParams& common,
        SharedPasses& shared) override {
        PassParams params = common;
        shader::ResolvedParams own{};
        own.motions = gpu::splitAddress(inputs.instantMotions->table);
        params.setMethod(own);
        ResolvePassOutputs found = mResolvePass.add(graph, inputs, settings, params, shared);
        mSurfaces.add(graph, inputs.surfaces, found, params);
        MotionBlurOutputs outputs = mResolvePass.end(graph, inputs, found, params, shared);
        outputs.color = mDiscs.add(graph, found, outputs.color, params);
        return outputs;
    }

    void count(uint32_t slot, Counters& counters) const override {
        mResolvePass.count(slot, counters);
    }

  private:
    ResolvePass mResolvePass;
    InstantSurfacesPass mSurfaces;
    LensDiscs mDiscs;
};

} // namespace

const Method kResolved = {
    .name = "resolved",
    .description = "what each pixel saw at each instant, looked up by the entities' motion",
    .publication = "this project",
    .sampleUnit = SampleUnit::Instants,
    .defaultSamples = 15,
    .readsEntityId = true,
    .readsLens = true,
    .readsInstantMotions = true,
    .usesUniformMotion = true,
    .listBytesPerPixel = 3, // the candidates
    .settings = {"history", "instantNoise", "secondRaster", "uniformMotionPx"},
    .views = {"last", "second"},
    .addBudgetLevels = [](BudgetLadder& ladder, const MotionBlurSettings& wanted
                       ) { addLookupLevels(ladder, wanted, 1.0); },
    .makePasses = [](gpu::Device& device, VkDescriptorSetLayout) -> std::unique_ptr<MethodPasses> {
        return std::make_unique<ResolvedPasses>(device);
    },
};

} // namespace shutter::motion_blur
