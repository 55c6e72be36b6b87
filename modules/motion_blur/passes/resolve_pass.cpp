// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/resolve_pass.h"

#include "spirv/motion_blur/resolved.comp.h"
#include "spirv/motion_blur/resolved_sort.comp.h"

#include "engine/core/check.h"
#include "engine/math/sampling.h"
#include "modules/motion_blur/instant_motions.h"
#include "modules/motion_blur/passes/dispatch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

namespace shutter::motion_blur {

namespace {

using graph::Access;

/// Bits of a surface's second word that hold its key: kKeyBits of resolved.glsl.
constexpr uint32_t kKeyMask = 0xFFFFFFu;

gpu::ComputePipelineDesc describeResolve(bool listsPixels) {
    std::vector<VkDescriptorType> bindings = listSearchBindings();
    bindings.insert(bindings.end(), 3, kBuffer);
    gpu::ComputePipelineDesc desc =
        describePass("resolve", motion_blur_resolved_comp, std::move(bindings));
    desc.specialization = {shader::kMixedList, listsPixels ? 1u : 0u};
    desc.subgroupSize = kDivergingSubgroup;
    return desc;
}

// Bits of the index of a SearchPipelines' pipeline. Without the code for what deforms, RADV's
// search has 27 % fewer instructions, and that of `courtyard` takes 0.313 and not 0.324 ms on an
// NVIDIA H200.
constexpr uint32_t kWithSecond = 1;
constexpr uint32_t kGeneral = 2;
constexpr uint32_t kWithParts = 4;
constexpr uint32_t kWithEdges = 8;
constexpr uint32_t kWithLens = 16;
constexpr uint32_t kWithCrowds = 32;

/// \param desc with constants 0 and 1, if it has any
gpu::ComputePipelineDesc specialize(gpu::ComputePipelineDesc desc, uint32_t bits) {
    desc.specialization.resize(2);
    if (bits & kGeneral)
        desc.specialization[0] = shader::kCandidateList;
    for (const uint32_t bit :
         {kWithSecond, kGeneral, kWithParts, kWithEdges, kWithLens, kWithCrowds})
        desc.specialization.push_back(bits & bit ? 1u : 0u);
    return desc;
}

/// Blue noise, [0, 1): nothing depends on chance.
gpu::Buffer makeNoise(gpu::Device& device) {
    constexpr uint32_t kSeed = 1;
    std::vector<float> shares;
    for (const uint32_t rank : math::makeBlueNoise(shader::kNoiseSidePx, kSeed))
        shares.push_back((float(rank) + 0.5f) / float(shader::kNoiseSidePx * shader::kNoiseSidePx));
    gpu::Buffer buffer(
        device,
        "instant noise",
        shares.size() * sizeof(float),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        gpu::MemoryUse::Stream
    );
    buffer.write(std::span<const float>(shares));
    return buffer;
}

/// What a pixel takes in frames that follow one another is spread evenly, however many they are: by
/// the golden ratio (Wolfe et al. 2022, "Spatiotemporal Blue Noise Masks", compare with it).
float turnOf(int64_t frameNumber) {
    constexpr double kGoldenRatio = 0.61803398874989485;
    const double turns = double(frameNumber) * kGoldenRatio;
    return static_cast<float>(turns - std::floor(turns));
}

/// Initial buffers of the lookup in a frame.
struct InitialBuffers {
    graph::BufferHandle counters;
    ListedPixels listed;
    std::array<graph::BufferHandle, 3> candidates; ///< by LayerIndex; invalid: no such layer
    std::array<DeformingTiles, 3> deforming;       ///< the same; invalid: nothing deforms
    CrowdBuffers crowds;                           ///< invalid: no tile can be crowded
    BrightPointBuffers points;                     ///< invalid: none are taken out
    SortedBlocks blocks;
};

InitialBuffers createInitialBuffers(
    graph::Graph& graph,
    const SurfaceLayersOutputs& layers,
    const PassParams& params,
    bool listsPixels,
    bool takesPoints,
    const InstantMotions& motions,
    Clears& clears
) {
    InitialBuffers initial;
    initial.counters = graph.createBuffer(
        "resolved counters", {sizeof(shader::ResolvedCounters), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}
    );
    clears.add(initial.counters, 0);
    if (listsPixels) {
        const VkDeviceSize pixels = VkDeviceSize(params.sizePx.x) * params.sizePx.y;
        initial.listed = {
            // Not cleared: the counters know how many there are.
            graph.createBuffer("listed pixels", {pixels * sizeof(glm::uvec2), kListUsage}),
            graph.createBuffer(
                "listed pixel arguments", {sizeof(shader::DispatchArguments), kArgumentsUsage}
            )};
        clears.addArguments(initial.listed.arguments, 1);
    }
    const auto create = [&](const SurfaceLayer& layer, LayerIndex index) {
        if (!layer.surface.isValid())
            return;
        const auto at = static_cast<size_t>(index);
        initial.candidates.at(at) = CandidateLists::create(graph, params, clears);
        if (motions.deforms.at(at))
            initial.deforming.at(at) = CandidateLists::createDeforming(graph, params, clears);
    };
    create(layers.raster, LayerIndex::Raster);
    create(layers.second, LayerIndex::Second);
    create(layers.last, LayerIndex::Last);
    if (motions.mayCrowd)
        initial.crowds = Crowds::create(graph, params, clears);
    if (takesPoints)
        initial.points = BrightPoints::create(graph, params, clears);
    // Blocks of general tiles use the list that otherwise holds candidates of the ray mask.
    initial.blocks = BlockSorter::create(graph, params, motions.isGeneral(), clears);
    return initial;
}

} // namespace

std::vector<VkDescriptorType> listSearchBindings() {
    return {kSampled, kSampled, kSampled, kSampled, kSampled, kStorage, kBuffer, kBuffer,
            kBuffer,  kSampled, kSampled, kBuffer,  kSampled, kSampled, kBuffer, kSampled,
            kBuffer,  kBuffer,  kBuffer,  kSampled, kSampled, kSampled, kSampled};
}

void SearchResources::use(graph::PassBuilder& builder) {
    builder.read(motionDepth, Access::SampledCompute);
    if (edgeSurface.isValid())
        builder.read(edgeSurface, Access::SampledCompute);
    for (const SurfaceLayer& layer : {layers.raster, layers.second, layers.last})
        for (const graph::ImageHandle image : {layer.color, layer.surface})
            if (image.isValid())
                builder.read(image, Access::SampledCompute);
    for (const graph::ImageHandle image : ways)
        if (image.isValid())
            builder.read(image, Access::SampledCompute);
    for (const graph::BufferHandle buffer :
         {candidates.raster,
          candidates.second,
          candidates.last,
          crowds,
          blockSamples,
          parts[0],
          parts[1],
          parts[2]})
        if (buffer.isValid())
            builder.read(buffer, Access::StorageRead);
    counters = builder.write(counters, Access::StorageWrite);
}

gpu::BindingList SearchResources::bind(
    const graph::PassResources& resources, gpu::Device& device, graph::ImageHandle target
) const {
    // Unused bindings still need a valid descriptor.
    const SurfaceLayer& last = layers.last.color.isValid() ? layers.last : layers.raster;
    const SurfaceLayer& second = layers.second.color.isValid() ? layers.second : layers.raster;
    const auto bufferOr = [&](graph::BufferHandle buffer, graph::BufferHandle other) {
        return resources.buffer(buffer.isValid() ? buffer : other);
    };
    gpu::BindingList bindings;
    for (const graph::ImageHandle image :
         {layers.raster.color, motionDepth, layers.raster.surface, last.color, last.surface})
        bindings.sampled(resources.view(image), device.nearestSampler());
    bindings.storage(resources.image(target));
    bindings.buffer(resources.buffer(candidates.raster))
        .buffer(bufferOr(candidates.last, candidates.raster))
        .buffer(resources.buffer(counters));
    for (const graph::ImageHandle color : {layers.raster.color, last.color})
        bindings.sampled(resources.view(color), device.linearSampler());
    bindings.buffer(bufferOr(blockSamples, counters));
    for (const graph::ImageHandle image : {second.color, second.surface})
        bindings.sampled(resources.view(image), device.nearestSampler());
    bindings.buffer(bufferOr(candidates.second, candidates.raster))
        .sampled(resources.view(second.color), device.linearSampler());
    for (const graph::BufferHandle buffer : parts)
        bindings.buffer(bufferOr(buffer, counters));
    for (const graph::ImageHandle image : ways)
        bindings.sampled(
            resources.view(image.isValid() ? image : layers.raster.surface), device.nearestSampler()
        );
    bindings.sampled(
        resources.view(edgeSurface.isValid() ? edgeSurface : layers.raster.surface),
        device.nearestSampler()
    );
    return bindings;
}

SearchPipelines::SearchPipelines(gpu::Device& device, const gpu::ComputePipelineDesc& desc)
    : mDevice(device), mDesc(desc), mAlwaysHasParts(isSoftware(device)) {}

const gpu::LazyPipeline&
SearchPipelines::find(const SearchResources& search, bool isGeneral) const {
    uint32_t bits = isGeneral ? kGeneral : 0;
    if (isGeneral && search.crowds.isValid())
        bits |= kWithCrowds;
    if (search.candidates.second.isValid())
        bits |= kWithSecond;
    const bool hasParts =
        std::any_of(search.parts.begin(), search.parts.end(), [](graph::BufferHandle parts) {
            return parts.isValid();
        });
    if (hasParts || mAlwaysHasParts)
        bits |= kWithParts;
    if (search.edgeSurface.isValid())
        bits |= kWithEdges;
    if (search.hasLens)
        bits |= kWithLens;
    const auto known = mPipelines.find(bits);
    if (known != mPipelines.end())
        return known->second;
    return mPipelines.try_emplace(bits, mDevice, specialize(mDesc, bits)).first->second;
}

ResolvePass::ResolvePass(gpu::Device& device, bool listsPixels)
    : mListsPixels(listsPixels), mDevice(device), mLayers(device), mCandidates(device),
      mCrowds(device), mParts(device), mPoints(device), mLensFilter(device),
      mSort(
          device,
          describePass(
              "sort candidates", motion_blur_resolved_sort_comp, {kBuffer, kBuffer, kBuffer}
          )
      ),
      mBlocks(device, !listsPixels), mResolve(device, describeResolve(listsPixels)),
      mRead(
          device,
          "resolved counters",
          kMaxSlots * sizeof(shader::ResolvedCounters),
          0,
          gpu::MemoryUse::Readback
      ) {
    mRead.writeZeros();
}

ResolvePassOutputs ResolvePass::add(
    graph::Graph& graph,
    const MotionBlurInputs& inputs,
    const MotionBlurSettings& settings,
    PassParams& params,
    SharedPasses& shared
) {
    const InstantMotions& motions = *inputs.instantMotions;
    SHUTTER_CHECK_EQ(motions.instantCount, countInstants(settings, motions.hasLens));
    const RasterHistory* const history = motions.history;
    const bool isKept = history && history->holds(params.sizePx);
    const bool hasLast = motions.hasLast && (isKept || motions.lent);
    const bool filtersLens = motions.hasLens && motions.filtersLens;
    auto own = params.getMethod<shader::ResolvedParams>();
    own.has = (hasLast ? shader::kHasLastLayer : 0u) |
              (motions.second ? shader::kHasSecondLayer : 0u) |
              (motions.drawWays ? shader::kHasWays : 0u) |
              (motions.hasLens ? shader::kHasLensPlaces : 0u) |
              (filtersLens ? shader::kFiltersLens : 0u) |
              (motions.isGeneral() ? shader::kHasGeneralTiles : 0u);
    describeInstants(inputs, settings, own);
    params.setMethod(own);
    if (!mBlocks.canFind(params))
        params.uniformMotionPx = 0.0f;
    ResolvePassOutputs outputs;
    SearchResources& search = outputs.search;
    search.layers = mLayers.add(graph, inputs, params, hasLast);
    search.motionDepth = inputs.motionDepth;
    search.hasLens = motions.hasLens;
    search.isGeneral = motions.isGeneral();
    search.filtersLens = filtersLens;
    search.edgeSurface = inputs.edgeSurface;
    mHistoryBytes = history ? history->bytes() : 0;
    const SurfaceLayer& raster = search.layers.raster;
    Clears clears;
    // A host's rays would meet the points that discs stand for.
    const bool takesPoints = motions.hasLens && !inputs.samples;
    const InitialBuffers initial = createInitialBuffers(
        graph, search.layers, params, mListsPixels, takesPoints, motions, clears
    );
    clears.declare(graph);
    if (takesPoints) {
        const BrightPointBuffers cleared = BrightPoints::getCleared(initial.points, clears);
        const BrightPointOutputs taken = mPoints.add(graph, inputs.color, raster, cleared, params);
        search.layers.raster.color = taken.color;
        outputs.points = taken.buffers;
    }
    outputs.listed = initial.listed;
    if (mListsPixels)
        outputs.listed.arguments = clears.get(initial.listed.arguments);
    search.counters = clears.get(initial.counters);
    CrowdBuffers crowds;
    if (motions.mayCrowd)
        crowds = {clears.get(initial.crowds.tiles), clears.get(initial.crowds.arguments)};
    const auto list = [&](const SurfaceLayer& layer, LayerIndex index) -> graph::BufferHandle {
        if (!layer.surface.isValid())
            return {};
        const auto at = static_cast<size_t>(index);
        const DeformingTiles& deforming = initial.deforming.at(at);
        CandidateInputs given{layer.surface, {}, clears.get(initial.candidates.at(at)), {}, crowds};
        if (index == LayerIndex::Raster)
            given.edgeSurface = inputs.edgeSurface;
        if (deforming.tiles.isValid())
            given.deforming = {clears.get(deforming.tiles), clears.get(deforming.arguments)};
        CandidateOutputs listed = mCandidates.add(graph, given, index, params);
        if (listed.deforming.tiles.isValid()) {
            if (motions.drawWays)
                search.ways.at(at) = motions.drawWays(graph, index, layer.surface, kKeyMask);
            const PartOutputs found = mParts.add(
                graph,
                {layer.surface,
                 inputs.motionDepth,
                 search.ways.at(at),
                 listed.deforming,
                 listed,
                 DeformingParts::create(graph, params)},
                index,
                params
            );
            listed = found.listed;
            search.parts.at(at) = found.parts;
        }
        crowds = listed.crowds;
        return listed.candidates;
    };
    SortedCandidates candidates;
    candidates.raster = list(raster, LayerIndex::Raster);
    candidates.second = list(search.layers.second, LayerIndex::Second);
    candidates.last = list(search.layers.last, LayerIndex::Last);
    if (motions.mayCrowd)
        search.crowds = mCrowds.add(graph, search.layers, inputs.motionDepth, crowds, params);
    search.candidates = addSort(graph, candidates, params);
    const BlockSampleOutputs blockSamples = mBlocks.addFind(
        graph,
        raster,
        {search.candidates,
         search.parts[static_cast<size_t>(LayerIndex::Raster)],
         search.crowds,
         search.counters,
         search.isGeneral},
        BlockSorter::getCleared(initial.blocks, clears),
        params
    );
    outputs.blocks = blockSamples.blocks;
    search.counters = blockSamples.counters;
    search.blockSamples = blockSamples.blockSamples;
    if (inputs.wantsCounters)
        shared.sorter.addCounters(graph, outputs.blocks, params, inputs.slot);
    const bool readsKept = !(raster.color == inputs.color);
    outputs.stillPixelsBy =
        readsKept && inputs.mayWriteColor() ? StaticPixelsBy::InPlace : shared.stillPixelsBy;
    graph::ImageHandle target = inputs.target;
    if (filtersLens && target.isValid()) {
        // The filter behind the search writes into it, and reads another image.
        target = {};
        outputs.stillPixelsBy = StaticPixelsBy::WholeCopy;
    }
    outputs.picture = shared.stillPixels.begin(graph, inputs.color, target, outputs.stillPixelsBy);
    // Pixels that may be traced are listed by the search.
    if (!mListsPixels)
        outputs.picture = mBlocks.addResolve(
            graph, raster, outputs.blocks, search.blockSamples, outputs.picture, params
        );
    addResolve(graph, outputs, false, params);
    if (search.isGeneral)
        addResolve(graph, outputs, true, params);
    return outputs;
}

void ResolvePass::describeInstants(
    const MotionBlurInputs& inputs, const MotionBlurSettings& settings, shader::ResolvedParams& own
) {
    own.instantCount = inputs.instantMotions->instantCount;
    own.setCount = own.instantCount / settings.sampleCount;
    if (inputs.instantMotions->hasLens || settings.instantNoise == InstantNoise::Off)
        return;
    if (!mNoise)
        mNoise = makeNoise(mDevice);
    own.noise = gpu::splitAddress(mNoise.address());
    if (settings.instantNoise == InstantNoise::PerFrame)
        own.turn = turnOf(inputs.frameNumber);
}

SortedCandidates ResolvePass::addSort(
    graph::Graph& graph, const SortedCandidates& listed, const PassParams& params
) const {
    return graph.addPass<SortedCandidates>(
        "sort candidates",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, SortedCandidates& data) {
            data.raster = builder.write(listed.raster, Access::StorageWrite);
            if (listed.second.isValid())
                data.second = builder.write(listed.second, Access::StorageWrite);
            if (listed.last.isValid())
                data.last = builder.write(listed.last, Access::StorageWrite);
        },
        [this, params](const SortedCandidates& data, graph::PassContext& context) {
            gpu::BindingList bindings;
            for (const graph::BufferHandle buffer : {data.raster, data.last, data.second})
                bindings.buffer(context.resources.buffer(buffer.isValid() ? buffer : data.raster));
            const glm::uvec2 tiles = countCandidateTiles(params);
            const uint32_t groupRows = (tiles.y + shader::kSortRows - 1) / shader::kSortRows;
            const glm::uvec2 extent(tiles.x, groupRows * shader::kGroupSize);
            dispatchPixels(context, mSort.get(), bindings, params, extent);
        }
    );
}

void ResolvePass::addResolve(
    graph::Graph& graph, ResolvePassOutputs& outputs, bool isGeneral, const PassParams& params
) const {
    struct Data {
        SearchResources search;
        BlockLists blocks;
        ListedPixels listed;
        graph::ImageHandle picture;
    };

    const BlockLists& lists = isGeneral ? outputs.blocks.candidates : outputs.blocks.lists;
    const Data& pass = graph.addPass<Data>(
        isGeneral ? "resolve, general" : "resolve",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.search = outputs.search;
            data.search.use(builder);
            mResolve.prepare(data.search, isGeneral);
            data.blocks = {
                builder.read(lists.blocks, Access::StorageRead),
                builder.read(lists.arguments, Access::IndirectRead)};
            if (mListsPixels)
                data.listed = {
                    builder.write(outputs.listed.pixels, Access::StorageWrite),
                    builder.write(outputs.listed.arguments, Access::StorageWrite)};
            data.picture = builder.write(outputs.picture, Access::StorageWriteDisjoint);
        },
        [this, isGeneral, params](const Data& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings = data.search.bind(resources, mDevice, data.picture);
            bindings.buffer(resources.buffer(data.blocks.blocks));
            // Unused bindings of the specialised shader still need a valid descriptor.
            const bool isListed = data.listed.pixels.isValid();
            for (const graph::BufferHandle buffer : {data.listed.pixels, data.listed.arguments})
                bindings.buffer(resources.buffer(isListed ? buffer : data.search.counters));
            dispatchList(
                context,
                mResolve.get(data.search, isGeneral),
                bindings,
                withCrowds(params, resources, data.search.crowds),
                data.blocks.arguments,
                isGeneral ? shader::kCandidateList : shader::kMixedList
            );
        }
    );
    outputs.search.counters = pass.search.counters;
    outputs.listed = pass.listed;
    outputs.picture = pass.picture;
}

MotionBlurOutputs ResolvePass::end(
    graph::Graph& graph,
    const MotionBlurInputs& inputs,
    const ResolvePassOutputs& found,
    const PassParams& params,
    SharedPasses& shared
) const {
    if (inputs.methodCountersEnabled())
        readCounters(graph, found.search.counters, inputs.slot);
    MotionBlurOutputs outputs;
    outputs.color = shared.stillPixels.end(
        graph,
        inputs.color,
        found.picture,
        found.blocks,
        found.search.isGeneral,
        params,
        found.stillPixelsBy
    );
    if (found.search.filtersLens)
        outputs.color = mLensFilter.add(graph, outputs.color, inputs.target, params);
    outputs.surfaces = found.surfaces;
    const SurfaceLayersOutputs& layers = found.search.layers;
    for (const View& view : {View{"second", layers.second.color}, View{"last", layers.last.color}})
        if (view.image.isValid())
            outputs.views.push_back(view);
    return outputs;
}

void ResolvePass::readCounters(graph::Graph& graph, graph::BufferHandle counters, uint32_t slot)
    const {
    struct Data {
        graph::BufferHandle source;
        graph::BufferHandle target;
    };

    const auto target = graph.importBuffer("resolved counters read", mRead.handle(), mRead.bytes());
    graph.addPass<Data>(
        "read resolved counters",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Data& data) {
            data.source = builder.read(counters, Access::TransferRead);
            data.target = builder.write(target, Access::TransferWrite);
            graph.markOutput(data.target);
        },
        [slot](const Data& data, graph::PassContext& context) {
            constexpr VkDeviceSize kBytes = sizeof(shader::ResolvedCounters);
            const VkBufferCopy region{0, slot * kBytes, kBytes};
            vkCmdCopyBuffer(
                context.commands,
                context.resources.buffer(data.source),
                context.resources.buffer(data.target),
                1,
                &region
            );
        }
    );
}

void ResolvePass::count(uint32_t slot, Counters& counters) const {
    shader::ResolvedCounters counted;
    std::memcpy(
        &counted, static_cast<const char*>(mRead.mapped()) + slot * sizeof(counted), sizeof(counted)
    );
    counters["unresolved samples"] = counted.unresolved;
    counters["samples from the second raster"] = counted.fromSecond;
    counters["samples from the last frame"] = counted.fromLast;
    counters["crowded tiles"] = counted.crowdedTiles;
    counters["history bytes"] = mHistoryBytes;
    if (!mListsPixels)
        return;
    counters["rays traced"] = counted.rays;
    uint64_t edges = 0;
    for (uint32_t i = shader::kFirstEdgeClass; i <= shader::kLastEdgeClass; ++i)
        edges += counted.classes[i];
    counters["uncertain samples"] = edges;
}

} // namespace shutter::motion_blur
