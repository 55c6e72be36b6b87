// SPDX-License-Identifier: MIT
// Tan, Cui, Bhojan, "Hybrid MBlur": inside a ray mask at moving silhouettes, rays past the
// foreground reveal a second layer. Each tap then takes the surface that the pixel saw at its
// instant, or, as in the paper, both layers are gathered and composited by weights.
#include "engine/core/check.h"
#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/passes/counts.h"
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
        : mDevice(device), mCounts(device), mMask(device), mReveal(device, sceneLayout),
          mLayer(device), mGather(device) {}

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
    struct Frame {
        graph::Graph& graph;
        const MotionBlurInputs& inputs;
        const PassParams& params;
        SharedPasses& shared;
        const TileMotionOutputs& tiles;
    };

    struct Blurred {
        graph::ImageHandle target{};
        MaskedPixels masked;
        SortedBlocks blocks; ///< with kMaskedList
        RayRevealOutputs reveal{};
    };

    Blurred addCounted(const Frame& frame);
    Blurred addWeighted(const Frame& frame);
    RayRevealOutputs addReveal(const Frame& frame, const MaskedPixels& masked);

    gpu::Device& mDevice;
    Counts mCounts;
    RayMask mMask;
    RayReveal mReveal;
    RevealedLayerPasses mLayer;
    Gather mGather;
};

RayMaskInputs makeMaskInputs(const MotionBlurInputs& inputs, const SortedBlocks& sorted) {
    return {
        inputs.motionDepth, inputs.normal, inputs.entityId, sorted, inputs.measureEdgesEverywhere};
}

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
    const Frame frame{graph, inputs, params, shared, tiles};
    const Blurred blurred =
        settings.composite == CompositeRule::Counted ? addCounted(frame) : addWeighted(frame);
    if (inputs.wantsCounters)
        shared.sorter.addCounters(graph, blurred.blocks, params, inputs.slot);
    const graph::ImageHandle mask = blurred.masked.mask;
    const RevealedLayerInputs layer{
        inputs.color, inputs.motionDepth, tiles.tiles, mask, blurred.reveal};
    const RevealedViews views = mLayer.addViews(graph, layer, params);
    const RayMaskInputs maskInputs = makeMaskInputs(inputs, blurred.blocks);

    MotionBlurOutputs outputs;
    outputs.views = {
        {"tile_max", tiles.tiles},
        {"tiles", tiles.dominant},
        {"edge", mMask.addEdgeView(graph, maskInputs, params)},
        {"mask", mask},
        {"reveal", views.color},
        {"reveal_motion", views.motionDepth},
        {"reveal_id", blurred.reveal.entityId},
        {"cost", shared.costView.add(graph, inputs.motionDepth, mask, blurred.blocks, params)}};
    outputs.color = shared.stillPixels.end(
        graph, inputs.color, blurred.target, blurred.blocks, true, params, shared.stillPixelsBy
    );
    return outputs;
}

HybridPasses::Blurred HybridPasses::addCounted(const Frame& frame) {
    const auto& [graph, inputs, params, shared, tiles] = frame;
    Clears clears;
    const SortedBlocks lists = BlockSorter::create(graph, params, true, clears);
    const ClearedCounts created = Counts::create(graph, params, clears);
    clears.declare(graph);
    const SortedBlocks sorted =
        shared.sorter.add(graph, tiles, BlockSorter::getCleared(lists, clears), params, true);
    graph::ImageHandle target = shared.stillPixels.begin(
        graph, inputs.color, inputs.target, shared.stillPixelsBy, sorted.lists, params
    );
    target = mGather.addUniform(
        graph, {inputs.color, inputs.motionDepth, tiles.dominant}, sorted, target, params
    );
    const CountInputs raster{inputs.color, inputs.motionDepth, tiles.dominant, inputs.entityId};
    const CountedRaster counted = mCounts.addRaster(
        graph, raster, sorted, Counts::getCleared(created, clears), target, params
    );
    Blurred blurred{.masked = counted.masked, .blocks = counted.blocks};
    blurred.reveal = addReveal(frame, counted.masked);
    blurred.target = mCounts.addRevealed(graph, raster, counted, blurred.reveal, params);
    return blurred;
}

HybridPasses::Blurred HybridPasses::addWeighted(const Frame& frame) {
    const auto& [graph, inputs, params, shared, tiles] = frame;
    Clears clears;
    const SortedBlocks lists = BlockSorter::create(graph, params, true, clears);
    const ClearedMask masks = RayMask::create(graph, params, clears);
    clears.declare(graph);
    const SortedBlocks sorted =
        shared.sorter.add(graph, tiles, BlockSorter::getCleared(lists, clears), params, true);
    const RayMaskOutputs mask = mMask.add(
        graph, makeMaskInputs(inputs, sorted), RayMask::getCleared(masks, clears), params
    );
    Blurred blurred{.masked = mask.masked, .blocks = mask.blocks};
    blurred.reveal = addReveal(frame, mask.masked);
    const RevealedLayerInputs layer{
        inputs.color, inputs.motionDepth, tiles.tiles, mask.masked.mask, blurred.reveal};
    const RevealedLayer revealed{
        blurred.reveal.color,
        blurred.reveal.motionDepth,
        mLayer.addDominant(graph, layer, mask, params),
        mask.masked.mask};
    const graph::ImageHandle target = shared.stillPixels.begin(
        graph, inputs.color, inputs.target, shared.stillPixelsBy, mask.blocks.lists, params
    );
    blurred.target = mGather.add(
        graph,
        {inputs.color, inputs.motionDepth, tiles.dominant, revealed},
        mask.blocks,
        target,
        params
    );
    return blurred;
}

RayRevealOutputs HybridPasses::addReveal(const Frame& frame, const MaskedPixels& masked) {
    const MotionBlurInputs& inputs = frame.inputs;
    const RayRevealInputs reveal{
        inputs.color,
        inputs.motionDepth,
        inputs.entityId,
        masked,
        inputs.rays.value_or(graph::RayScene{}),
        inputs.slot,
        inputs.methodCountersEnabled()};
    if (!inputs.reveal)
        return mReveal.add(frame.graph, reveal, frame.params);
    if (inputs.methodCountersEnabled())
        mReveal.countOwn(frame.graph, masked.list, inputs.slot);
    return addHostReveal(frame.graph, mDevice, reveal, *inputs.reveal);
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
