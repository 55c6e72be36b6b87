// SPDX-License-Identifier: MIT
// `resolved`, with rays where looked-up samples are missing or uncertain: scales from a post effect
// to ground truth.
#include "spirv/motion_blur/adaptive.comp.h"

#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/passes/dispatch.h"
#include "modules/motion_blur/passes/host_samples_pass.h"
#include "modules/motion_blur/passes/instant_surfaces.h"
#include "modules/motion_blur/passes/lens_discs.h"
#include "modules/motion_blur/passes/resolve_pass.h"
#include "modules/motion_blur/shared_passes.h"

#include <cmath>

namespace shutter::motion_blur {

extern const Method kAdaptive;

namespace {

using graph::Access;

gpu::ComputePipelineDesc describeTrace(VkDescriptorSetLayout sceneLayout) {
    std::vector<VkDescriptorType> bindings = listSearchBindings();
    bindings.push_back(kBuffer);
    bindings.push_back(VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR);
    gpu::ComputePipelineDesc desc =
        describePass("trace samples", motion_blur_adaptive_comp, std::move(bindings));
    desc.interface.sceneLayout = sceneLayout;
    return desc;
}

class AdaptivePasses : public MethodPasses {
  public:
    AdaptivePasses(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
        : mDevice(device), mResolvePass(device, true), mSurfaces(device), mDiscs(device),
          mOwnSamples(device), mTrace(device, describeTrace(sceneLayout)) {}

    MotionBlurOutputs
    add(graph::Graph& graph,
        const MotionBlurInputs& inputs,
        const MotionBlurSettings& settings,
        const PassParams& params,
        SharedPasses& shared) override;

    void count(uint32_t slot, Counters& counters) const override {
        mResolvePass.count(slot, counters);
    }

  private:
    void addTrace(
        graph::Graph& graph,
        const graph::TimedRays& rays,
        ResolvePassOutputs& found,
        const PassParams& params
    ) const;

    gpu::Device& mDevice;
    ResolvePass mResolvePass;
    InstantSurfacesPass mSurfaces;
    LensDiscs mDiscs;
    HostSamplesPass mOwnSamples;
    SearchPipelines mTrace;
};

uint32_t countRays(float perPixel, glm::uvec2 sizePx) {
    const double rays = double(perPixel) * sizePx.x * sizePx.y;
    return rays < double(shader::kNoRayLimit) ? static_cast<uint32_t>(rays) : shader::kNoRayLimit;
}

MotionBlurOutputs AdaptivePasses::add(
    graph::Graph& graph,
    const MotionBlurInputs& inputs,
    const MotionBlurSettings& settings,
    const PassParams& common,
    SharedPasses& shared
) {
    PassParams params = common;
    shader::ResolvedParams own{};
    own.motions = gpu::splitAddress(inputs.instantMotions->table);
    own.rayLimit = countRays(settings.raysPerPixel, params.sizePx);
    if (inputs.timedRays) {
        own.frame = gpu::splitAddress(inputs.timedRays->frameConstants);
        own.timed = gpu::splitAddress(inputs.timedRays->timedConstants);
    }
    params.setMethod(own);
    ResolvePassOutputs found = mResolvePass.add(graph, inputs, settings, params, shared);
    mSurfaces.add(graph, inputs.surfaces, found, params);
    if (inputs.samples)
        mOwnSamples.add(graph, *inputs.samples, found, params);
    else if (inputs.timedRays)
        addTrace(graph, *inputs.timedRays, found, params);
    MotionBlurOutputs outputs = mResolvePass.end(graph, inputs, found, params, shared);
    outputs.color = mDiscs.add(graph, found, outputs.color, params);
    return outputs;
}

void AdaptivePasses::addTrace(
    graph::Graph& graph,
    const graph::TimedRays& rays,
    ResolvePassOutputs& found,
    const PassParams& params
) const {
    struct Data {
        SearchResources search;
        ListedPixels listed;
        graph::ImageHandle picture;
    };

    const Data& pass = graph.addPass<Data>(
        "trace samples",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            for (const graph::BufferHandle structure : {rays.tlasBuffer, rays.boxesBuffer})
                if (structure.isValid())
                    builder.read(structure, Access::AccelerationRead);
            if (rays.deformedBuffer.isValid())
                builder.read(rays.deformedBuffer, Access::ShaderRead);
            data.search = found.search;
            data.search.use(builder);
            mTrace.prepare(data.search, data.search.isGeneral);
            data.listed = {
                builder.read(found.listed.pixels, Access::StorageRead),
                builder.read(found.listed.arguments, Access::IndirectRead)};
            data.picture = builder.write(found.picture, Access::StorageWrite);
        },
        [this, tlas = rays.tlas, textures = rays.textures, params](
            const Data& data, graph::PassContext& context
        ) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings = data.search.bind(resources, mDevice, data.picture);
            bindings.buffer(resources.buffer(data.listed.pixels)).accelerationStructure(tlas);
            const PassParams own = withCrowds(params, resources, data.search.crowds);
            const gpu::Pipeline& pipeline = mTrace.get(data.search, data.search.isGeneral);
            context.frame.bind(pipeline, bindings, &own, sizeof(own), textures);
            vkCmdDispatchIndirect(context.commands, resources.buffer(data.listed.arguments), 0);
        }
    );
    found.search.counters = pass.search.counters;
    found.picture = pass.picture;
}

void addAdaptiveLevels(BudgetLadder& ladder, const MotionBlurSettings& wanted) {
    ladder.changeMethod("resolved", "all rays", wanted.sampleCount, 0.3);
    addLookupLevels(ladder, wanted, 0.3);
}

} // namespace

const Method kAdaptive = {
    .name = "adaptive",
    .description = "resolved, and rays for what the rasters do not hold",
    .publication = "this project",
    .rays = RayNeed::Query,
    .sampleUnit = SampleUnit::Instants,
    .defaultSamples = 15,
    .readsEntityId = true,
    .readsLens = true,
    .readsInstantMotions = true,
    .usesUniformMotion = true,
    .listBytesPerPixel = 8, // the listed pixels
    .settings = {"history", "instantNoise", "raysPerPixel", "secondRaster", "uniformMotionPx"},
    .views = {"last", "second"},
    .addBudgetLevels = addAdaptiveLevels,
    .makePasses = [](gpu::Device& device,
                     VkDescriptorSetLayout sceneLayout) -> std::unique_ptr<MethodPasses> {
        return std::make_unique<AdaptivePasses>(device, sceneLayout);
    },
};

} // namespace shutter::motion_blur
