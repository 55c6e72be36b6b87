// SPDX-License-Identifier: MIT
#include "modules/depth_of_field/depth_of_field.h"

#include "spirv/depth_of_field/reach.comp.h"
#include "spirv/depth_of_field/tiles.comp.h"

#include "engine/core/check.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "engine/scene/lens.h"

#include <algorithm>
#include <array>
#include <string>

namespace shutter::depth_of_field {

// Each is defined in filters/, in the file of its name.
extern const Filter kHybrid;
extern const Filter kJimenez2014;
extern const Filter kNearFar;

namespace {

using graph::Access;

constexpr VkFormat kColorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat kTileFormat = VK_FORMAT_R32G32_SFLOAT;
constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;

/// A pass that writes one image and samples so many.
gpu::ComputePipelineDesc
describePass(const std::string& name, std::span<const uint32_t> spirv, size_t sampledCount) {
    gpu::ComputePipelineDesc desc;
    desc.name = name;
    desc.spirv = spirv;
    desc.interface.bindings.assign(sampledCount, kSampled);
    desc.interface.bindings.push_back(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    desc.interface.pushConstantBytes = sizeof(shader::LensFilterParams);
    return desc;
}

constexpr uint32_t divideUp(uint32_t value, uint32_t by) {
    return (value + by - 1) / by;
}

/// A pass that samples images and writes one of that size and format.
/// \param groups of threads
template <size_t N>
graph::ImageHandle addLensPass(
    graph::Graph& graph,
    gpu::Device& device,
    const gpu::LazyPipeline& pipeline,
    const char* name,
    const std::array<graph::ImageHandle, N>& sampled,
    const graph::TransientImageDesc& target,
    glm::uvec2 groups,
    const shader::LensFilterParams& params
) {
    struct Data {
        std::array<graph::ImageHandle, N> sampled;
        graph::ImageHandle target;
    };

    return graph
        .addPass<Data>(
            name,
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                for (size_t i = 0; i < N; ++i)
                    data.sampled[i] = builder.read(sampled[i], Access::SampledCompute);
                data.target = builder.write(graph.createImage(name, target), Access::StorageWrite);
            },
            [&device, &pipeline, groups, params](const Data& data, graph::PassContext& recording) {
                gpu::BindingList bindings;
                for (const graph::ImageHandle image : data.sampled)
                    bindings.sampled(recording.resources.view(image), device.nearestSampler());
                bindings.storage(recording.resources.image(data.target));
                recording.frame.bind(pipeline.get(), bindings, &params, sizeof(params));
                vkCmdDispatch(recording.commands, groups.x, groups.y, 1);
            }
        )
        .target;
}

} // namespace

const Filter& getFilter(std::string_view name) {
    for (const Filter* filter : {&kHybrid, &kJimenez2014, &kNearFar})
        if (filter->name == name)
            return *filter;
    SHUTTER_CHECK(false, "there is no filter {}", name);
    return kNearFar;
}

uint32_t computeTileSize(uint32_t height) {
    // 16 pixels of 270: circles of confusion of up to a sixth of the picture's height in radius.
    constexpr uint32_t kTilesPerHeight = 17;
    return std::max(divideUp(height, kTilesPerHeight), shader::kLensGroup);
}

DepthOfField::DepthOfField(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
    : mDevice(device), mSceneLayout(sceneLayout),
      mTiles(device, describePass("lens tiles", depth_of_field_tiles_comp, 1)),
      mReach(device, describePass("lens reach", depth_of_field_reach_comp, 1)) {}

void DepthOfField::configure(const DepthOfFieldSettings& settings) {
    SHUTTER_CHECK(settings.taps > 0 && settings.taps <= kMaxTaps, "{} taps", settings.taps);
    SHUTTER_CHECK(settings.rays > 0 && settings.rays <= kMaxRays, "{} rays", settings.rays);
    mSettings = settings;
}

render::Needs DepthOfField::decide(const render::DecideContext& context) const {
    if (!mSettings.filter)
        return {.run = {false, "no filter is chosen"}};
    if (mSettings.filter->tracesRays && !context.facts.deviceHasRayQuery)
        return {.run = {false, "it needs ray queries, which the device lacks"}};
    render::Needs needs{.run = {true, "the picture is filtered by the camera's lens"}};
    if (mSettings.filter->tracesRays)
        needs.rays = {true, "rays see past what is near"};
    return needs;
}

void DepthOfField::extract(render::ExtractContext& context) {
    const double s = context.facts.rasterTime;
    const scene::CameraLens lens = context.motion.cameraLens(s);
    mInverseFocus = 1.0 / lens.focusDistance;
    mTurn = context.view.lensTurn.value_or(0);
    mConfusionPx = 0.0;
    // It is 0 for an orthographic camera, which has no lens.
    const double pixelWidthAtOne = context.frame.constants.pixelFootprint.x;
    if (pixelWidthAtOne > 0.0)
        mConfusionPx =
            scene::computeLensRadius(lens, context.motion.cameraYFov(s)) / pixelWidthAtOne;
}

void DepthOfField::declare(render::PictureContext& context) {
    mHasTraced.at(context.slot) = false;
    if (!(mConfusionPx > 0.0))
        return;
    shader::LensFilterParams params{};
    params.sizePx = {context.facts.width, context.facts.height};
    params.tilePx = computeTileSize(context.facts.height);
    params.tileCount = {
        divideUp(params.sizePx.x, params.tilePx), divideUp(params.sizePx.y, params.tilePx)};
    params.tapCount = mSettings.taps;
    params.confusionPx = float(mConfusionPx);
    params.inverseFocus = float(mInverseFocus);
    const auto tiles = addTiles(context.graph, context.gbuffer.motionDepth, params);
    context.color = addFilter(context, addReach(context.graph, tiles, params), params);
}

graph::ImageHandle DepthOfField::addTiles(
    graph::Graph& graph, graph::ImageHandle motionDepth, const shader::LensFilterParams& params
) const {
    const graph::TransientImageDesc target{params.tileCount.x, params.tileCount.y, kTileFormat};
    return addLensPass(
        graph,
        mDevice,
        mTiles,
        "lens tiles",
        std::array{motionDepth},
        target,
        params.tileCount,
        params
    );
}

graph::ImageHandle DepthOfField::addReach(
    graph::Graph& graph, graph::ImageHandle tiles, const shader::LensFilterParams& params
) const {
    const graph::TransientImageDesc target{params.tileCount.x, params.tileCount.y, kTileFormat};
    const glm::uvec2 groups{
        divideUp(params.tileCount.x, shader::kLensGroup),
        divideUp(params.tileCount.y, shader::kLensGroup)};
    return addLensPass(
        graph, mDevice, mReach, "lens reach", std::array{tiles}, target, groups, params
    );
}

graph::ImageHandle DepthOfField::addFilter(
    const render::PictureContext& context,
    graph::ImageHandle reach,
    const shader::LensFilterParams& params
) {
    const graph::TransientImageDesc target{params.sizePx.x, params.sizePx.y, kColorFormat};
    const glm::uvec2 groups{
        divideUp(params.sizePx.x, shader::kLensGroup),
        divideUp(params.sizePx.y, shader::kLensGroup)};
    const auto filter = [&](const auto& sampled) {
        return addLensPass(
            context.graph,
            mDevice,
            findFilterPipeline(),
            "lens filter",
            sampled,
            target,
            groups,
            params
        );
    };
    const graph::ImageHandle motionDepth = context.gbuffer.motionDepth;
    if (!mSettings.filter->tracesRays)
        return filter(std::array{context.color, motionDepth, reach});
    const LensRaysOutputs seen = addRays(context, reach, params);
    return filter(std::array{context.color, motionDepth, reach, seen.near, seen.behind});
}

LensRaysOutputs DepthOfField::addRays(
    const render::PictureContext& context,
    graph::ImageHandle reach,
    const shader::LensFilterParams& params
) {
    SHUTTER_CHECK(context.rays, "no scene to trace rays in");
    if (!mRays)
        mRays.emplace(mDevice, mSceneLayout);
    shader::LensFilterParams own = params;
    own.frame = gpu::splitAddress(context.rays->frameConstants);
    own.rayCount = mSettings.rays;
    own.firstRay = mTurn * mSettings.rays;
    mHasTraced.at(context.slot) = true;
    return mRays->add(
        context.graph,
        {context.color, context.gbuffer.motionDepth, reach, *context.rays, context.slot},
        own
    );
}

void DepthOfField::finish(render::FinishedFrame& frame) {
    if (frame.ran && mHasTraced.at(frame.slot))
        mRays->count(frame.slot, frame.counters);
}

const gpu::LazyPipeline& DepthOfField::findFilterPipeline() {
    const Filter& filter = *mSettings.filter;
    return mFilters
        .try_emplace(
            &filter,
            mDevice,
            describePass(
                std::string("lens ") + filter.name, filter.spirv, filter.tracesRays ? 5 : 3
            )
        )
        .first->second;
}

} // namespace shutter::depth_of_field
