// SPDX-License-Identifier: MIT
#include "modules/bloom/bloom.h"

#include "spirv/bloom/bloom_down.comp.h"
#include "spirv/bloom/bloom_up.comp.h"

#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "shaders/bloom/bloom_shared.h"
#include "shaders/common/numeric.glsl"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace shutter::bloom {

namespace {

using graph::Access;

static_assert(kMaxThreshold == shader::kMaxColor);

constexpr VkFormat kFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr uint32_t kMinSidePx = 4; ///< of the smallest image
constexpr uint32_t kMaxLevels = 10;
/// Levels that light is spread over. Each but the coarsest has kOwnShare of the light that the
/// finer ones leave.
constexpr int kSpreadLevels = 8;
constexpr float kOwnShare = 0.3f;

/// Share of the coarser levels in a level's output. Light spreads over the same share of the
/// picture at every resolution: with more levels the finest add no light, with fewer the finest
/// adds that of all missing levels. \param level 1: the finest, below `count`
float findCoarserShare(int level, int count) {
    const int extra = count - kSpreadLevels;
    if (level <= extra)
        return 1.0f;
    return std::pow(1.0f - kOwnShare, float(level == 1 && extra < 0 ? 1 - extra : 1));
}

gpu::ComputePipelineDesc describeDown() {
    gpu::ComputePipelineDesc desc;
    desc.name = "bloom down";
    desc.spirv = bloom_bloom_down_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    desc.interface.pushConstantBytes = sizeof(shader::BloomParams);
    return desc;
}

gpu::ComputePipelineDesc describeUp() {
    gpu::ComputePipelineDesc desc;
    desc.name = "bloom up";
    desc.spirv = bloom_bloom_up_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    desc.interface.pushConstantBytes = sizeof(shader::BloomParams);
    return desc;
}

glm::uvec2 sizeOf(const graph::Graph& graph, graph::ImageHandle image) {
    const graph::TransientImageDesc& desc = graph.describeImage(image);
    return {desc.width, desc.height};
}

void dispatch(
    graph::PassContext& recording,
    const gpu::Pipeline& pipeline,
    const gpu::BindingList& bindings,
    const shader::BloomParams& params
) {
    recording.frame.bind(pipeline, bindings, &params, sizeof(params));
    vkCmdDispatch(recording.commands, (params.sizePx.x + 7) / 8, (params.sizePx.y + 7) / 8, 1);
}

} // namespace

float findKneeStart(const BloomSettings& settings) {
    return settings.threshold * (1.0f - settings.knee);
}

uint32_t countLevels(uint32_t width, uint32_t height) {
    uint32_t levels = 0;
    for (uint32_t side = std::min(width, height) / 2; side >= kMinSidePx; side /= 2)
        ++levels;
    return std::min(levels, kMaxLevels);
}

Bloom::Bloom(gpu::Device& device, const BloomSettings& settings)
    : mDevice(device), mSettings(settings), mDown(device, describeDown()),
      mUp(device, describeUp()) {}

void Bloom::configure(const BloomSettings& settings) {
    mSettings = settings;
}

render::Needs Bloom::decide(const render::DecideContext& context) const {
    return {.run = decideRun(context.facts)};
}

core::Decision Bloom::decideRun(const render::ViewFacts& facts) const {
    if (!(mSettings.share > 0.0f))
        return {false, "the lens scatters no light"};
    if (countLevels(facts.width, facts.height) == 0)
        return {false, "the picture is too small"};
    if (!facts.lastBrightest)
        return {true, "the lens scatters light, and no previous picture shows how much there is"};
    const float start = findKneeStart(mSettings);
    if (*facts.lastBrightest <= start)
        return {
            false,
            fmt::format(
                "the last picture's brightest channel, {:.3g}, is not above the knee, which begins "
                "at {:.3g}",
                *facts.lastBrightest,
                start
            )};
    return {true, "the lens scatters the light of highlights"};
}

void Bloom::declare(render::PictureContext& context) {
    graph::Graph& graph = context.graph;
    std::vector<graph::ImageHandle> levels{context.color};
    VkExtent2D size{context.facts.width, context.facts.height};
    for (uint32_t i = countLevels(size.width, size.height); i > 0; --i) {
        size = {(size.width + 1) / 2, (size.height + 1) / 2};
        // The images below hold nothing but highlights.
        const bool isPicture = levels.size() == 1;
        levels.push_back(addDown(graph, levels.back(), size, isPicture ? mSettings.threshold : 0));
    }
    graph::ImageHandle scattered = levels.back();
    const int count = static_cast<int>(levels.size()) - 1;
    for (int i = count - 1; i > 0; --i)
        scattered = addUp(graph, levels[size_t(i)], scattered, findCoarserShare(i, count), 0);
    context.color = addUp(graph, context.color, scattered, mSettings.share, mSettings.threshold);
}

graph::ImageHandle Bloom::addDown(
    graph::Graph& graph, graph::ImageHandle source, VkExtent2D size, float threshold
) const {
    struct Data {
        graph::ImageHandle source;
        graph::ImageHandle half;
    };

    const shader::BloomParams params{
        {size.width, size.height},
        sizeOf(graph, source),
        0.0f,
        threshold,
        threshold * mSettings.knee};
    return graph
        .addPass<Data>(
            "bloom down",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                data.source = builder.read(source, Access::SampledCompute);
                data.half = builder.write(
                    graph.createImage("bloom", {size.width, size.height, kFormat}),
                    Access::StorageWrite
                );
            },
            [this, params](const Data& data, graph::PassContext& recording) {
                gpu::BindingList bindings;
                bindings.sampled(recording.resources.view(data.source), mDevice.nearestSampler())
                    .storage(recording.resources.image(data.half));
                dispatch(recording, mDown.get(), bindings, params);
            }
        )
        .half;
}

graph::ImageHandle Bloom::addUp(
    graph::Graph& graph,
    graph::ImageHandle fine,
    graph::ImageHandle coarse,
    float share,
    float threshold
) const {
    struct Data {
        graph::ImageHandle fine;
        graph::ImageHandle coarse;
        graph::ImageHandle mixed;
    };

    const shader::BloomParams params{
        sizeOf(graph, fine), sizeOf(graph, coarse), share, threshold, threshold * mSettings.knee};
    return graph
        .addPass<Data>(
            "bloom up",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                data.fine = builder.read(fine, Access::SampledCompute);
                data.coarse = builder.read(coarse, Access::SampledCompute);
                data.mixed = builder.write(
                    graph.createImage("bloom", {params.sizePx.x, params.sizePx.y, kFormat}),
                    Access::StorageWrite
                );
            },
            [this, params](const Data& data, graph::PassContext& recording) {
                gpu::BindingList bindings;
                bindings.sampled(recording.resources.view(data.fine), mDevice.nearestSampler())
                    .sampled(recording.resources.view(data.coarse), mDevice.linearSampler())
                    .storage(recording.resources.image(data.mixed));
                dispatch(recording, mUp.get(), bindings, params);
            }
        )
        .mixed;
}

} // namespace shutter::bloom
