// SPDX-License-Identifier: MIT
#include "modules/accumulate/accumulate.h"

#include "spirv/accumulate/accumulate.comp.h"

#include "engine/core/check.h"
#include "engine/gpu/frame.h"
#include "engine/graph/execute.h"
#include "engine/math/lens_pairs.h"
#include "engine/math/sampling.h"
#include "engine/scene/shutter.h"
#include "shaders/accumulate/accumulate_shared.h"
#include "shaders/common/sampling.glsl"

#include <cmath>

namespace shutter::accumulate {

namespace {

gpu::ComputePipelineDesc describePipeline() {
    gpu::ComputePipelineDesc desc;
    desc.name = "accumulate";
    desc.spirv = accumulate_accumulate_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    desc.interface.pushConstantBytes = sizeof(shader::AccumulateParams);
    return desc;
}

/// Cranley-Patterson shift of a seed, [0, 1); 0 for seed 0.
double seedShift(uint32_t seed, double irrational) {
    const double shift = seed * irrational;
    return shift - std::floor(shift);
}

double wrap(double x) {
    return x - std::floor(x);
}

/// A point of Sobol's sequence in the middle of its stratum, moved by the seed.
/// \param irrational a number of the seed's shift for each axis
math::dvec2
placeOf(const math::uvec2& point, uint32_t count, uint32_t seed, const math::dvec2& irrational) {
    return {
        wrap(point.x * 0x1p-32 + 0.5 / count + seedShift(seed, irrational.x)),
        wrap(point.y * 0x1p-32 + 0.5 / count + seedShift(seed, irrational.y))};
}

} // namespace

extract::ViewRequest makeInstant(
    const extract::ViewRequest& view,
    uint32_t index,
    uint32_t count,
    PixelModel pixel,
    uint32_t seed
) {
    SHUTTER_CHECK(index < count, "{} of {}", index, count);
    extract::ViewRequest instant = view;
    // What appears or is hidden during the exposure is there at some instants and not at others.
    if (view.exposure.open < view.exposure.close)
        instant.exposure = scene::takePart(view.exposure, view.exposure.open, view.exposure.close);
    instant.instant = scene::invertLight(view.exposure, (index + 0.5) / count);
    if (view.usesLens)
        instant.lensPlace = placeOf(
            math::lensPoint(index, count), count, seed, {0.8566748838545029, 0.7338918566271260}
        );
    if (pixel == PixelModel::Centre)
        return instant;
    instant = makeSubpixel(instant, index, count, seed);
    // Halton's base 2 is Sobol's first dimension, which the lens has.
    if (view.usesLens)
        instant.jitterPx =
            placeOf(
                shader::sobolPoint45(index), count, seed, {0.6287067210378087, 0.5385972572236101}
            ) -
            0.5;
    return instant;
}

extract::ViewRequest
makeSubpixel(const extract::ViewRequest& view, uint32_t index, uint32_t count, uint32_t seed) {
    SHUTTER_CHECK(index < count, "{} of {}", index, count);
    extract::ViewRequest part = view;
    const math::dvec2 place = math::halton23(index);
    part.jitterPx = {
        wrap(place.x + 0.5 / count + seedShift(seed, 0.7548776662466927)) - 0.5,
        wrap(place.y + 0.5 / count + seedShift(seed, 0.5698402909980532)) - 0.5};
    part.lodBias = view.lodBias - 0.5f * std::log2(static_cast<float>(count));
    return part;
}

Accumulate::Accumulate(gpu::Device& device)
    : mDevice(device), mPipeline(device, describePipeline()) {}

void Accumulate::setInstant(uint32_t index, uint32_t count) {
    SHUTTER_CHECK(index < count, "{} of {}", index, count);
    mFrame = {index == 0, index + 1 == count, 1.0, double(count)};
}

render::Needs Accumulate::decide(const render::DecideContext&) const {
    return {.run = {true, "every frame of the picture is added"}};
}

void Accumulate::declare(render::PictureContext& context) {
    struct Data {
        graph::ImageHandle color;
        graph::ImageHandle sum;
    };

    const render::ViewFacts& facts = context.facts;
    if (mFrame.isFirst || mSum.desc().width != facts.width || mSum.desc().height != facts.height) {
        SHUTTER_CHECK(mFrame.isFirst, "the picture's size changed between its frames");
        gpu::ImageDesc desc;
        desc.width = facts.width;
        desc.height = facts.height;
        desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
        desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                     VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        if (!(mSum.desc() == desc))
            mSum = gpu::Image(mDevice, "accumulated color", desc);
    }
    shader::AccumulateParams params{};
    params.sizePx = {facts.width, facts.height};
    params.clears = mFrame.isFirst ? 1 : 0;
    params.weight = static_cast<float>(mFrame.weight);
    params.scale = mFrame.isLast ? 1.0f / static_cast<float>(mFrame.total) : 1.0f;
    const auto imported = context.graph.importImage(
        "accumulated color",
        mSum,
        mFrame.isFirst ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_GENERAL,
        VK_IMAGE_LAYOUT_GENERAL
    );
    const Data& pass = context.graph.addPass<Data>(
        "accumulate",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data& data) {
            data.color = builder.read(context.color, graph::Access::SampledCompute);
            data.sum = builder.write(imported, graph::Access::StorageWrite);
        },
        [this, params](const Data& data, graph::PassContext& recording) {
            gpu::BindingList bindings;
            bindings.sampled(recording.resources.view(data.color), mDevice.nearestSampler())
                .storage(recording.resources.image(data.sum));
            recording.frame.bind(mPipeline, bindings, &params, sizeof(params));
            vkCmdDispatch(
                recording.commands, (params.sizePx.x + 7) / 8, (params.sizePx.y + 7) / 8, 1
            );
        }
    );
    if (mFrame.isLast)
        context.color = pass.sum;
}

} // namespace shutter::accumulate
