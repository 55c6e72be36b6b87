// SPDX-License-Identifier: MIT
#include "modules/tonemap/tonemap.h"

#include "spirv/tonemap/tonemap.comp.h"

#include "engine/core/check.h"
#include "engine/gpu/frame.h"
#include "engine/graph/execute.h"
#include "shaders/tonemap/tonemap.glsl"
#include "shaders/tonemap/tonemap_shared.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace shutter::tonemap {

namespace {

gpu::ComputePipelineDesc describePipeline(bool measures) {
    gpu::ComputePipelineDesc desc;
    desc.name = "tone map";
    desc.spirv = tonemap_tonemap_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    desc.interface.pushConstantBytes = sizeof(shader::TonemapParams);
    desc.specialization = {measures ? 1u : 0u};
    return desc;
}

glm::uvec2 countGroups(const render::ViewFacts& facts) {
    return (glm::uvec2(facts.width, facts.height) + shader::kTonemapGroup - 1u) /
           shader::kTonemapGroup;
}

} // namespace

float computeGain(const TonemapSettings& settings) {
    return static_cast<float>(std::exp2(std::clamp(settings.exposureValue, -32.0, 32.0)));
}

Tonemap::Tonemap(gpu::Device& device, const TonemapSettings& settings)
    : mDevice(device), mSettings(settings), mPipeline(device, describePipeline(false)),
      mMeasuring(device, describePipeline(true)) {}

render::Needs Tonemap::decide(const render::DecideContext& context) const {
    if (!context.facts.displayWanted)
        return {.run = {false, "only the linear picture is wanted"}};
    return {.run = {true, "a picture for a display is wanted"}};
}

void Tonemap::declare(render::PictureContext& context) {
    struct Data {
        graph::ImageHandle color;
        graph::ImageHandle display;
        graph::BufferHandle brightest; ///< invalid: not requested
    };

    shader::TonemapParams params{};
    params.sizePx = {context.facts.width, context.facts.height};
    params.gain = computeGain(mSettings);
    params.operator_ =
        mSettings.op == Operator::Neutral ? shader::kTonemapNeutral : shader::kTonemapNone;
    const glm::uvec2 groups = countGroups(context.facts);
    const graph::BufferHandle brightest = prepareBrightest(context);
    params.brightest = gpu::splitAddress(mBrightest.at(context.slot).groups.address());
    const Data& pass = context.graph.addPass<Data>(
        "tone map",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.color = builder.read(context.color, graph::Access::SampledCompute);
            const auto display = context.graph.createImage(
                "display", {params.sizePx.x, params.sizePx.y, VK_FORMAT_R8G8B8A8_UNORM}
            );
            data.display = builder.write(display, graph::Access::StorageWrite);
            if (!brightest.isValid())
                return;
            data.brightest = builder.write(brightest, graph::Access::StorageWrite);
            context.graph.markOutput(data.brightest);
        },
        [this, params, groups](const Data& data, graph::PassContext& recording) {
            gpu::BindingList bindings;
            bindings.sampled(recording.resources.view(data.color), mDevice.nearestSampler())
                .storage(recording.resources.image(data.display));
            const gpu::LazyPipeline& pipeline = data.brightest.isValid() ? mMeasuring : mPipeline;
            recording.frame.bind(pipeline.get(), bindings, &params, sizeof(params));
            vkCmdDispatch(recording.commands, groups.x, groups.y, 1);
        }
    );
    context.display = pass.display;
}

graph::BufferHandle Tonemap::prepareBrightest(render::PictureContext& context) {
    Brightest& own = mBrightest.at(context.slot);
    own.groupCount = 0;
    if (!context.facts.brightestWanted)
        return {};
    const glm::uvec2 groups = countGroups(context.facts);
    own.groupCount = groups.x * groups.y;
    const VkDeviceSize bytes = VkDeviceSize(own.groupCount) * sizeof(float);
    if (own.groups.bytes() < bytes)
        own.groups = gpu::Buffer(
            mDevice,
            "brightest channels",
            bytes,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Readback
        );
    return context.graph.importBuffer(
        "brightest channels", own.groups.handle(), own.groups.bytes()
    );
}

void Tonemap::finish(render::FinishedFrame& frame) {
    Brightest& own = mBrightest.at(frame.slot);
    if (!frame.ran || own.groupCount == 0)
        return;
    const auto* groups = static_cast<const float*>(own.groups.mapped());
    frame.measures[render::kBrightest] = double(*std::max_element(groups, groups + own.groupCount));
}

image::Image computeDisplayImage(const image::Image& linear, const TonemapSettings& settings) {
    SHUTTER_CHECK(linear.channels == 1 || linear.channels == 3, "{} channels", linear.channels);
    const size_t channels = linear.channels;
    SHUTTER_CHECK_EQ(linear.pixels.size(), size_t(linear.width) * linear.height * channels);
    const float gain = computeGain(settings);
    image::Image display = linear;
    for (size_t i = 0; i < linear.pixels.size(); i += channels) {
        const float* in = linear.pixels.data() + i;
        const glm::vec3 stored(in[0], in[channels == 3 ? 1 : 0], in[channels == 3 ? 2 : 0]);
        // Infinity would become NaN in the operator.
        glm::vec3 color = glm::clamp(stored * gain, 0.0f, shader::kMaxColor);
        if (settings.op == Operator::Neutral)
            color = shader::toneMapNeutral(color);
        color = shader::encodeSrgb3(color);
        const bool hasNan = std::isnan(stored.x) || std::isnan(stored.y) || std::isnan(stored.z);
        for (size_t c = 0; c < channels; ++c)
            display.pixels[i + c] = hasNan ? std::nanf("") : color[int(c)];
    }
    return display;
}

} // namespace shutter::tonemap
