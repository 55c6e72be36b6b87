// SPDX-License-Identifier: MIT
#include "modules/particles/particle_pass.h"

#include "spirv/particles/particle.frag.h"
#include "spirv/particles/particle.vert.h"
#include "spirv/particles/particle_composite.frag.h"
#include "spirv/render/sky.vert.h"

#include "engine/core/check.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"

#include <array>
#include <span>
#include <vector>

namespace shutter::particles {

namespace {

constexpr VkFormat kParticleFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr uint32_t kCorners = 6;

VkDeviceSize alignPart(VkDeviceSize bytes) {
    return (bytes + 255) / 256 * 256;
}

/// Returns the number of parts of the exposure in which the particles are drawn, as required by
/// their textures or their background: four, one or, with few instants, some in between.
uint32_t countDraws(const ParticleTables& tables, const render::OverlayContext& targets) {
    const uint32_t behind = targets.surfaces ? targets.surfaces->rectangle.partCount : 1;
    return tables.parts <= behind ? behind : behind > 1 ? shader::kMaxParticleParts : tables.parts;
}

/// Whether passes can draw on it as it is.
bool isDrawable(const graph::Graph& graph, graph::ImageHandle image) {
    return !graph.resources()[image.resource].imported &&
           graph.describeImage(image).format == kParticleFormat;
}

} // namespace

shader::ParticleDraw ParticleBuffer::upload(const ParticleTables& tables) {
    SHUTTER_CHECK(!tables.empty(), "no particle");
    std::vector<shader::ParticleEmitterRow> emitters = tables.emitters;
    for (shader::ParticleEmitterRow& row : emitters)
        if (row.texture != shader::kNoParticleTexture)
            row.texture *= 2; // as sRGB (TextureTable)
    const VkDeviceSize emittersAt = alignPart(std::span(tables.rows).size_bytes());
    const VkDeviceSize camerasAt = emittersAt + alignPart(std::span(emitters).size_bytes());
    const VkDeviceSize total = camerasAt + alignPart(std::span(tables.cameras).size_bytes());
    if (mBuffer.bytes() < total)
        mBuffer = gpu::Buffer(
            mDevice,
            "particles",
            total + total / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Stream
        );
    mBuffer.write(std::span(tables.rows), 0);
    mBuffer.write(std::span<const shader::ParticleEmitterRow>(emitters), emittersAt);
    mBuffer.write(std::span(tables.cameras), camerasAt);
    shader::ParticleDraw draw{};
    draw.rows = gpu::splitAddress(mBuffer.address());
    draw.emitters = gpu::splitAddress(mBuffer.address() + emittersAt);
    draw.cameras = gpu::splitAddress(mBuffer.address() + camerasAt);
    draw.rasterTime = tables.rasterTime;
    draw.cameraCount = static_cast<uint32_t>(tables.cameras.size());
    return draw;
}

const gpu::Pipeline& ParticlePass::findDraw(const DrawKey& key) {
    const auto known = mDraws.find(key);
    if (known != mDraws.end())
        return known->second;
    gpu::GraphicsPipelineDesc desc;
    desc.name = "particles";
    desc.vertexSpirv = particles_particle_vert;
    desc.fragmentSpirv = particles_particle_frag;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    desc.interface.pushConstantBytes = sizeof(shader::ParticleDraw);
    desc.interface.sceneLayout = mScene.textureLayout();
    desc.colorFormats = {key.format};
    desc.blend = key.isLayer ? gpu::Blend::PremultipliedLayer : gpu::Blend::Premultiplied;
    desc.specialization = {key.readsInstants ? 1u : 0u};
    return mDraws.emplace(key, gpu::Pipeline(mDevice, desc)).first->second;
}

const gpu::Pipeline& ParticlePass::findComposite(const CompositeKey& key) {
    const auto known = mComposites.find(key);
    if (known != mComposites.end())
        return known->second;
    gpu::GraphicsPipelineDesc desc;
    desc.name = "particle composite";
    desc.vertexSpirv = render_sky_vert;
    desc.fragmentSpirv = particles_particle_composite_frag;
    desc.interface.bindings.assign(
        1 + shader::kMaxParticleParts, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
    );
    desc.interface.bindings.push_back(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    desc.interface.pushConstantBytes = sizeof(uint32_t);
    desc.colorFormats = {key.format};
    desc.specialization = {key.readsParts ? 1u : 0u};
    return mComposites.emplace(key, gpu::Pipeline(mDevice, desc)).first->second;
}

graph::ImageHandle ParticlePass::declareDraw(
    const Draws& draws, graph::ImageHandle target, const shader::ParticleDraw& draw, bool isLayer
) {
    struct Data {
        graph::ImageHandle target;
        graph::ImageHandle depth;
        graph::BufferHandle instants;
    };

    const render::OverlayContext& targets = draws.context;
    const gpu::Pipeline& pipeline = findDraw(
        {draws.context.graph.describeImage(target).format, isLayer, targets.surfaces.has_value()}
    );
    return draws.context.graph
        .addPass<Data>(
            "particles",
            graph::PassKind::Raster,
            [&](graph::PassBuilder& builder, Data& data) {
                data.depth = builder.read(targets.motionDepth, graph::Access::SampledFragment);
                if (targets.surfaces)
                    data.instants =
                        builder.read(targets.surfaces->words, graph::Access::ShaderRead);
                std::optional<graph::ClearColor> clear;
                if (isLayer)
                    clear = graph::ClearColor::floats(0.0f, 0.0f, 0.0f, 1.0f);
                data.target = builder.colorTarget(target, clear);
            },
            [this, &pipeline, draw, tables = draws.tables, count = draws.count](
                const Data& data, graph::PassContext& context
            ) {
                gpu::BindingList bindings;
                bindings.sampled(context.resources.view(data.depth), mDevice.nearestSampler());
                bindings.buffer(
                    data.instants.isValid() ? context.resources.buffer(data.instants) : tables
                );
                context.frame.bind(pipeline, bindings, &draw, sizeof(draw), mScene.textureSet());
                vkCmdSetCullMode(context.commands, VK_CULL_MODE_NONE);
                vkCmdSetFrontFace(context.commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
                vkCmdDraw(context.commands, kCorners, count, 0, 0);
            }
        )
        .target;
}

graph::ImageHandle
ParticlePass::declareComposite(const Draws& draws, std::span<const graph::ImageHandle> layers) {
    struct Data {
        graph::ImageHandle color;
        std::array<graph::ImageHandle, shader::kMaxParticleParts> parts;
        graph::BufferHandle instants;
        graph::ImageHandle target;
    };

    const render::OverlayContext& targets = draws.context;
    const graph::TransientImageDesc desc = draws.context.graph.describeImage(targets.color);
    const bool readsParts = targets.surfaces && targets.surfaces->rectangle.partCount > 1;
    const gpu::Pipeline& pipeline = findComposite({desc.format, readsParts});
    const auto target = draws.context.graph.createImage("color with particles", desc);
    return draws.context.graph
        .addPass<Data>(
            "particle composite",
            graph::PassKind::Raster,
            [&](graph::PassBuilder& builder, Data& data) {
                data.color = builder.read(targets.color, graph::Access::SampledFragment);
                for (size_t i = 0; i < data.parts.size(); ++i)
                    data.parts[i] = i < layers.size()
                                        ? builder.read(layers[i], graph::Access::SampledFragment)
                                        : data.parts[0];
                if (readsParts)
                    data.instants =
                        builder.read(targets.surfaces->words, graph::Access::ShaderRead);
                data.target =
                    builder.colorTarget(target, graph::ClearColor::floats(0.0f, 0.0f, 0.0f, 0.0f));
            },
            [this, &pipeline, tables = draws.tables, count = uint32_t(layers.size())](
                const Data& data, graph::PassContext& context
            ) {
                gpu::BindingList bindings;
                bindings.sampled(context.resources.view(data.color), mDevice.nearestSampler());
                for (const graph::ImageHandle part : data.parts)
                    bindings.sampled(context.resources.view(part), mDevice.nearestSampler());
                bindings.buffer(
                    data.instants.isValid() ? context.resources.buffer(data.instants) : tables
                );
                context.frame.bind(pipeline, bindings, &count, sizeof(count));
                vkCmdSetCullMode(context.commands, VK_CULL_MODE_NONE);
                vkCmdSetFrontFace(context.commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
                vkCmdDraw(context.commands, 3, 1, 0, 0);
            }
        )
        .target;
}

graph::ImageHandle ParticlePass::declare(
    const ParticleTables& tables, ParticleBuffer& buffer, const render::OverlayContext& targets
) {
    graph::Graph& graph = targets.graph;
    shader::ParticleDraw draw = buffer.upload(tables);
    draw.frame = gpu::splitAddress(targets.frameConstants);
    draw.response = gpu::splitAddress(targets.response);
    const graph::TransientImageDesc desc = graph.describeImage(targets.color);
    draw.jitter =
        math::vec2(-2.0 * targets.jitterPx / math::dvec2(double(desc.width), double(desc.height)));
    draw.lightShare = tables.isInstant ? math::vec2(0.0f) : math::vec2(0.0f, 1.0f);
    const Draws draws{targets, buffer.handle(), static_cast<uint32_t>(tables.rows.size())};
    const uint32_t parts = countDraws(tables, targets);
    if (parts == 1 && !tables.mayOverflow && isDrawable(graph, targets.color))
        return declareDraw(draws, targets.color, draw, false);
    std::vector<graph::ImageHandle> layers;
    for (uint32_t part = 0; part < parts; ++part) {
        if (parts > 1)
            draw.lightShare = math::vec2(float(part), float(part + 1)) / float(parts);
        const auto layer =
            graph.createImage("particles", {desc.width, desc.height, kParticleFormat});
        layers.push_back(declareDraw(draws, layer, draw, true));
    }
    return declareComposite(draws, layers);
}

} // namespace shutter::particles
