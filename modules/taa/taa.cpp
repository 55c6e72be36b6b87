// SPDX-License-Identifier: MIT
#include "modules/taa/taa.h"

#include "spirv/taa/taa.comp.h"

#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "shaders/taa/taa_shared.h"

#include <array>

namespace shutter::taa {

namespace {

using graph::Access;

constexpr VkFormat kFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
/// Textures of one sample per pixel are this much sharper, in levels of detail: less is nearer to
/// the mean over the pixel also where only motion blur smooths them.
constexpr float kLodBias = -1.0f;
/// Those of kPlaceCount samples are so by as much again: two levels are a quarter of the width.
constexpr float kStaticLodBias = -1.0f;

gpu::ComputePipelineDesc describePipeline() {
    gpu::ComputePipelineDesc desc;
    desc.name = "taa";
    desc.spirv = taa_taa_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    desc.interface.pushConstantBytes = sizeof(shader::TaaParams);
    return desc;
}

struct Data {
    graph::ImageHandle color;
    graph::ImageHandle entityId;
    graph::ImageHandle picture;
    graph::ImageHandle kept;
    graph::ImageHandle keptRow;
};

shader::TaaParams
makeParams(const render::PictureContext& context, const StaticLayer::Frame& frame) {
    shader::TaaParams params{};
    params.sizePx = {context.facts.width, context.facts.height};
    params.jitterPx = math::vec2(context.view.jitterPx);
    params.frame = gpu::splitAddress(context.frameConstants);
    params.rows = frame.rows;
    params.hasLast = frame.hasLast ? 1 : 0;
    params.mayDiffer = frame.mayDiffer ? 1 : 0;
    return params;
}

} // namespace

math::dvec2 computeJitterPx(int64_t frameNumber) {
    constexpr auto kCount = int64_t{kPlaceCount};
    const auto index = static_cast<uint32_t>((frameNumber % kCount + kCount) % kCount);
    constexpr std::array<uint32_t, 4> kSecond{8, 12, 10, 15}; // directions of the second dimension
    uint32_t x = 0;
    uint32_t y = 0;
    for (uint32_t bit = 0; bit < kSecond.size(); ++bit)
        if ((index >> bit & 1u) != 0) {
            x ^= 8u >> bit;
            y ^= kSecond[bit];
        }
    return (math::dvec2(x, y) + 0.5) / double(kPlaceCount) - 0.5;
}

extract::ViewRequest makeJittered(const extract::ViewRequest& view, int64_t frameNumber) {
    extract::ViewRequest jittered = view;
    jittered.jitterPx = computeJitterPx(frameNumber);
    jittered.jittered = extract::Jittered::Static;
    jittered.samplesEdges = true;
    jittered.lodBias = view.lodBias + kLodBias;
    jittered.staticLodBias = kStaticLodBias;
    return jittered;
}

Taa::Taa(gpu::Device& device)
    : mDevice(device), mPipeline(device, describePipeline()), mStatic(device) {}

render::Needs Taa::decide(const render::DecideContext&) const {
    if (!mEnabled)
        return {.run = {false, "no temporal anti-aliasing is wanted"}};
    return {.run = {true, "each frame samples another place in the pixel of static surfaces"}};
}

void Taa::extract(render::ExtractContext& context) {
    mStatic.extract(context);
    context.colorJitterPx = math::dvec2(0.0);
}

void Taa::declare(render::PictureContext& context) {
    if (!mStatic.isGathering())
        return;
    graph::Graph& graph = context.graph;
    const StaticLayer::Frame frame = mStatic.turn(context);
    const shader::TaaParams params = makeParams(context, frame);
    const Data& pass = graph.addPass<Data>(
        "taa",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.color = builder.read(context.color, Access::SampledCompute);
            data.entityId = builder.read(context.gbuffer.entityId, Access::SampledCompute);
            data.picture = builder.write(
                graph.createImage("picture", {params.sizePx.x, params.sizePx.y, kFormat}),
                Access::StorageWrite
            );
            const auto keep = [&](const char* name, const gpu::Image& image) {
                const VkImageLayout before =
                    frame.hasLast ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_UNDEFINED;
                return builder.write(
                    graph.importImage(name, image, before, VK_IMAGE_LAYOUT_GENERAL),
                    Access::StorageWrite
                );
            };
            data.kept = keep("static colour", frame.images->color);
            data.keptRow = keep("static row", frame.images->row);
        },
        [this, params](const Data& data, graph::PassContext& recording) {
            const graph::PassResources& resources = recording.resources;
            gpu::BindingList bindings;
            for (const graph::ImageHandle image : {data.color, data.entityId})
                bindings.sampled(resources.view(image), mDevice.nearestSampler());
            for (const graph::ImageHandle image : {data.picture, data.kept, data.keptRow})
                bindings.storage(resources.image(image));
            recording.frame.bind(mPipeline.get(), bindings, &params, sizeof(params));
            vkCmdDispatch(
                recording.commands, (params.sizePx.x + 7) / 8, (params.sizePx.y + 7) / 8, 1
            );
        }
    );
    graph.markOutput(pass.kept);
    graph.markOutput(pass.keptRow);
    context.color = pass.picture;
}

void Taa::finish(render::FinishedFrame& frame) {
    if (!frame.ran)
        mStatic.forget();
}

} // namespace shutter::taa
