// SPDX-License-Identifier: MIT
// Tan, Cui, Bhojan, "Hybrid MBlur": inside a ray mask at moving silhouettes, rays past the
// foreground reveal a second layer. Each tap then takes the surface that the pixel saw at its
// instant, or, as in the paper, both layers are gathered and composited by weights.
#include "engine/core/check.h"
#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/passes/gather.h"
#include "modules/motion_blur/passes/host_reveal_pass.h"
#include "modules/motion_blur/passes/ray_mask.h"
#include "modules/motion_blur/passes/ray_reveal.h"
#include "modules/motion_blur/passes/revealed_layer.h"
#include "modules/motion_blur/shared_passes.h"
#include "shaders/motion_blur/hybrid_shared.h"

namespace shutter::motion_blur {

extern const Method kHybrid;

namespace {

class HybridPasses : public MethodPasses {
  public:
    HybridPasses(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
        : mDevice(device), mMask(device), mReveal(device, sceneLayout), mLayer(device),
          mGather(device) {}

    MotionBlurOutputs
    add(graph::Graph& graph,
        const MotionBlurInputs& inputs,
        const MotionBlurSettings& settings,
        const PassParams& params,
        SharedPasses& shared) override;

    bool isReady() const override { return mReveal.isReady(); }

    void count(uint32_t slot, Counters& counters) const override {
        const RayReveal::Counts counted = mReveal.count(slot);
        counters["pixels masked"] = counted.maskedPixels;
        counters["rays traced"] = counted.raysTraced;
    }

  private:
    gpu::Device& mDevice;
    RayMask mMask;
    RayReveal mReveal;
    RevealedLayerPasses mLayer;
    Gather mGather;
};

MotionBlurOutputs HybridPasses::add(
    graph::Graph& graph,
    const MotionBlurInputs& inputs,
    const MotionBlurSettings& settings,
    const PassParams& resolved,
    SharedPasses& shared
) {
    PassParams params = resolved;
    auto own = params.getMethod<shader::HybridParams>();
    if (inputs.rays)
        own.frame = gpu::splitAddress(inputs.rays->frameConstants);
    params.setMethod(own);
    const TileMotionOutputs tiles = shared.tileMotion.add(graph, inputs.motionDepth, params);
    Clears clears;
    const SortedBlocks lists = BlockSorter::create(graph, params, true, clears);
    const ClearedMask masks = RayMask::create(graph, params, clears);
    clears.declare(graph);
    const SortedBlocks sorted =
        shared.sorter.add(graph, tiles, BlockSorter::getCleared(lists, clears), params, true);
    const RayMaskOutputs mask = mMask.add(
        graph,
        {inputs.motionDepth, inputs.normal, inputs.entityId, sorted, inputs.measureEdgesEverywhere},
        RayMask::getCleared(masks, clears),
        params
    );
    if (inputs.wantsCounters)
        shared.sorter.addCounters(graph, mask.blocks, params, inputs.slot);
    const RayRevealInputs revealInputs{
        inputs.color,
        inputs.motionDepth,
        inputs.entityId,
        mask.mask,
        mask.list,
        mask.arguments,
        inputs.rays.value_or(graph::RayScene{}),
        inputs.slot,
        inputs.methodCountersEnabled()};
    if (inputs.reveal && inputs.methodCountersEnabled())
        mReveal.countOwn(graph, mask.list, inputs.slot);
    const RayRevealOutputs reveal =
        inputs.reveal ? addHostReveal(graph, mDevice, revealInputs, *inputs.reveal)
                      : mReveal.add(graph, revealInputs, params);
    const RevealedLayerInputs layerInputs{
        inputs.color, inputs.motionDepth, tiles.tiles, mask, reveal};
    RevealedLayer layer{reveal.color, reveal.motionDepth, reveal.entityId, mask.mask, {}};
    if (settings.composite == CompositeRule::Weights)
        layer.dominant = mLayer.addDominant(graph, layerInputs, params);
    const RevealedViews views = mLayer.addViews(graph, layerInputs, params);
    const graph::ImageHandle target = shared.stillPixels.begin(
        graph, inputs.color, inputs.target, shared.stillPixelsBy, mask.blocks.lists, params
    );
    const graph::ImageHandle filtered = mGather.add(
        graph,
        {inputs.color, inputs.motionDepth, tiles.dominant, inputs.entityId, layer},
        mask.blocks,
        target,
        params
    );

    MotionBlurOutputs outputs;
    outputs.views = {
        {"tile_max", tiles.tiles},
        {"tiles", tiles.dominant},
        {"edge", mask.edge},
        {"mask", mask.mask},
        {"reveal", views.color},
        {"reveal_motion", views.motionDepth},
        {"reveal_id", reveal.entityId},
        {"cost", shared.costView.add(graph, inputs.motionDepth, mask.mask, mask.blocks, params)}};
    outputs.color = shared.stillPixels.end(
        graph, inputs.color, filtered, mask.blocks, true, params, shared.stillPixelsBy
    );
    return outputs;
}

void resolveHybrid(const MotionBlurSettings& settings, PassParams& params) {
    shader::HybridParams own{};
    own.gather = {
        settings.foregroundMagnification,
        settings.backgroundMagnification,
        settings.halfResolutionPx,
        0.0f};
    own.edgeThreshold = settings.edgeThreshold;
    own.rayShare = settings.rayShare;
    own.luminanceThreshold = settings.luminanceThreshold;
    own.recursionLimit = settings.recursionLimit;
    if (settings.objectTest == ObjectTest::Luminance)
        own.flags |= shader::kFlagLuminanceTest | shader::kFlagSteppingReveal;
    if (settings.revealTraversal == RevealTraversal::Stepping)
        own.flags |= shader::kFlagSteppingReveal;
    if (settings.maskTest == MaskTest::Relative)
        own.flags |= shader::kFlagRelativeMask;
    params.setMethod(own);
}

void addHybridLevels(BudgetLadder& ladder, const MotionBlurSettings& wanted) {
    ladder.halveResolution(0.95);
    for (const float share : {0.75f, 0.5f, 0.25f})
        ladder.shareRays(share * wanted.rayShare, 0.5 + 0.42 * share);
    ladder.reduceSamples(shareOfSamples(wanted.sampleCount, 0.8), 0.56);
    ladder.reduceSamples(shareOfSamples(wanted.sampleCount, 0.6), 0.5);
    ladder.changeMethod("gather", "all rays", ladder.next().sampleCount, 0.35);
    ladder.reduceSamplesInSteps(wanted.sampleCount, 0.35);
}

} // namespace

const Method kHybrid = {
    .name = "hybrid",
    .description = "counts what each pixel saw, with the background that rays reveal (the paper)",
    .publication = "Tan, Cui, Bhojan, Hybrid MBlur",
    .standIn = "gather",
    .rays = RayNeed::Any,
    .readsNormal = true,
    .readsEntityId = true,
    .usesUniformMotion = true,
    .listBytesPerPixel = 4, // the list of masked pixels
    .settings =
        {"tileSizePx",
         "neighbourhoodTiles",
         "softDepthExtent",
         "softDepthShare",
         "jitter",
         "maxMotionDepth",
         "foregroundMagnification",
         "uniformMotionPx",
         "halfResolutionPx",
         "composite",
         "backgroundMagnification",
         "edgeThreshold",
         "maskTest",
         "recursionLimit",
         "objectTest",
         "revealTraversal",
         "rayShare",
         "luminanceThreshold"},
    .views = {"tile_max", "tiles", "edge", "mask", "reveal", "reveal_motion", "cost"},
    .resolve = resolveHybrid,
    // Other tests than by id, and steps that end at a limit, show an entity behind itself.
    .alwaysTraces =
        [](const MotionBlurSettings& settings) {
            return settings.objectTest != ObjectTest::MeshId ||
                   settings.revealTraversal != RevealTraversal::Single;
        },
    .addBudgetLevels = addHybridLevels,
    .makePasses = [](gpu::Device& device,
                     VkDescriptorSetLayout sceneLayout) -> std::unique_ptr<MethodPasses> {
        return std::make_unique<HybridPasses>(device, sceneLayout);
    },
};

} // namespace shutter::motion_blur
