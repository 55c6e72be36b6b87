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

gpu::ComputePipelineDesc describePipeline() {
    gpu::ComputePipelineDesc desc;
    desc.name = "tone map";
    desc.spirv = tonemap_tonemap_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    desc.interface.pushConstantBytes = sizeof(shader::TonemapParams);
    return desc;
}

} // namespace

float computeGain(const TonemapSettings& settings) {
    return static_cast<float>(std::exp2(std::clamp(settings.exposureValue, -32.0, 32.0)));
}

Tonemap::Tonemap(gpu::Device& device, const TonemapSettings& settings)
    : mSampler(device.nearestSampler()), mSettings(settings),
      mPipeline(device, describePipeline()) {}

core::Decision Tonemap::ask(const render::ViewFacts& facts) const {
    if (!facts.displayWanted)
        return {false, "only the linear picture is wanted"};
    return {true, "a picture for a display is wanted"};
}

void Tonemap::declare(render::PostContext& context) {
    struct Data {
        graph::ImageHandle color;
        graph::ImageHandle display;
    };

    shader::TonemapParams params{};
    params.sizePx = {context.facts.width, context.facts.height};
    params.gain = computeGain(mSettings);
    params.operator_ =
        mSettings.op == Operator::Neutral ? shader::kTonemapNeutral : shader::kTonemapNone;
    const Data& pass = context.graph.addPass<Data>(
        "tone map",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.color = builder.read(context.color, graph::Access::SampledCompute);
            const auto display = context.graph.createImage(
                "display", {params.sizePx.x, params.sizePx.y, VK_FORMAT_R8G8B8A8_UNORM}
            );
            data.display = builder.write(display, graph::Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& recording) {
            gpu::BindingList bindings;
            bindings.sampled(recording.resources.view(data.color), mSampler)
                .storage(recording.resources.image(data.display));
            recording.frame.bind(mPipeline, bindings, &params, sizeof(params));
            vkCmdDispatch(
                recording.commands, (params.sizePx.x + 7) / 8, (params.sizePx.y + 7) / 8, 1
            );
        }
    );
    context.display = pass.display;
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
