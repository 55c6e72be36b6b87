// SPDX-License-Identifier: MIT
#include "modules/taa/taa.h"

#include "spirv/taa/taa.comp.h"

#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "engine/math/sampling.h"
#include "shaders/taa/taa_shared.h"

namespace shutter::taa {

namespace {

using graph::Access;

constexpr VkFormat kFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkImageLayout kKeptLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
/// Textures of a single frame are this much sharper, in levels of detail: as for four samples a
/// pixel. All kPlaceCount would bear more, but the motion's resampling does not.
constexpr float kLodBias = -1.0f;

gpu::ComputePipelineDesc describePipeline() {
    gpu::ComputePipelineDesc desc;
    desc.name = "taa";
    desc.spirv = taa_taa_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    desc.interface.pushConstantBytes = sizeof(shader::TaaParams);
    return desc;
}

struct Data {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle entityId;
    graph::ImageHandle last; ///< invalid: there is none
    graph::ImageHandle lastDepth;
    graph::ImageHandle picture;
    graph::ImageHandle kept;
    graph::ImageHandle keptDepth;
};

graph::ImageHandle readLast(
    graph::PassBuilder& builder, graph::Graph& graph, const char* name, const gpu::Image& image
) {
    return builder.read(
        graph.importImage(name, image, kKeptLayout, kKeptLayout), Access::SampledCompute
    );
}

graph::ImageHandle writeKept(
    graph::PassBuilder& builder, graph::Graph& graph, const char* name, const gpu::Image& image
) {
    return builder.write(
        graph.importImage(name, image, VK_IMAGE_LAYOUT_UNDEFINED, kKeptLayout), Access::StorageWrite
    );
}

shader::TaaParams makeParams(const render::PostContext& context, const LastPicture::Frame& frame) {
    shader::TaaParams params{};
    params.sizePx = {context.facts.width, context.facts.height};
    params.jitterPx = math::vec2(context.view.jitterPx);
    params.last = frame.places;
    params.leastShare = 1.0f / float(kMostFrames);
    params.motionScale = frame.motionScale;
    params.hasLast = frame.last ? 1 : 0;
    params.isPerspective = frame.isPerspective ? 1 : 0;
    return params;
}

} // namespace

math::dvec2 computeJitterPx(int64_t frameNumber) {
    constexpr auto kCount = int64_t{kPlaceCount};
    const auto index = static_cast<uint32_t>((frameNumber % kCount + kCount) % kCount);
    return math::halton23(index + 1) - 0.5; // the first is the corner
}

extract::ViewRequest makeJittered(const extract::ViewRequest& view, int64_t frameNumber) {
    extract::ViewRequest jittered = view;
    jittered.jitterPx = computeJitterPx(frameNumber);
    jittered.lodBias = view.lodBias + kLodBias;
    return jittered;
}

Taa::Taa(gpu::Device& device)
    : mDevice(device), mPipeline(device, describePipeline()), mLast(device) {}

core::Decision Taa::ask(const render::ViewFacts&) const {
    if (!mEnabled)
        return {false, "no temporal anti-aliasing is wanted"};
    return {true, "each frame samples another place in the pixel"};
}

void Taa::extract(render::ExtractContext& context) {
    mLast.extract(context);
    context.colorJitterPx = math::dvec2(0.0);
}

void Taa::declare(render::PostContext& context) {
    graph::Graph& graph = context.graph;
    const LastPicture::Frame frame = mLast.turn(context);
    const shader::TaaParams params = makeParams(context, frame);
    const Data& pass = graph.addPass<Data>(
        "taa",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.color = builder.read(context.color, Access::SampledCompute);
            data.motionDepth = builder.read(context.gbuffer.motionDepth, Access::SampledCompute);
            data.entityId = builder.read(context.gbuffer.entityId, Access::SampledCompute);
            if (frame.last) {
                data.last = readLast(builder, graph, "last picture", frame.last->picture);
                data.lastDepth = readLast(builder, graph, "last depth", frame.last->depth);
            }
            data.picture = builder.write(
                graph.createImage("picture", {params.sizePx.x, params.sizePx.y, kFormat}),
                Access::StorageWrite
            );
            data.kept = writeKept(builder, graph, "kept picture", frame.kept->picture);
            data.keptDepth = writeKept(builder, graph, "kept depth", frame.kept->depth);
        },
        [this, params](const Data& data, graph::PassContext& recording) {
            const graph::PassResources& resources = recording.resources;
            // A binding that the shader does not use is something all the same.
            const bool hasLast = data.last.isValid();
            const graph::ImageHandle last = hasLast ? data.last : data.color;
            const graph::ImageHandle lastDepth = hasLast ? data.lastDepth : data.motionDepth;
            gpu::BindingList bindings;
            for (const graph::ImageHandle image : {data.color, data.motionDepth, data.entityId})
                bindings.sampled(resources.view(image), mDevice.nearestSampler());
            bindings.sampled(resources.view(last), mDevice.linearSampler())
                .storage(resources.image(data.picture))
                .storage(resources.image(data.kept))
                .sampled(resources.view(lastDepth), mDevice.nearestSampler())
                .storage(resources.image(data.keptDepth));
            recording.frame.bind(mPipeline.get(), bindings, &params, sizeof(params));
            vkCmdDispatch(
                recording.commands, (params.sizePx.x + 7) / 8, (params.sizePx.y + 7) / 8, 1
            );
        }
    );
    graph.markOutput(pass.kept);
    graph.markOutput(pass.keptDepth);
    context.color = pass.picture;
}

void Taa::finish(render::FinishedFrame& frame) {
    if (!frame.ran)
        mLast.forget();
}

} // namespace shutter::taa
