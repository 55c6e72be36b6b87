// SPDX-License-Identifier: MIT
#include "engine/render/particles.h"

#include "spirv/render/particle.frag.h"
#include "spirv/render/particle.vert.h"
#include "spirv/render/particle_composite.frag.h"
#include "spirv/render/sky.vert.h"

#include "engine/core/check.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"

#include <array>
#include <span>
#include <vector>

namespace shutter::render {

namespace {

constexpr VkFormat kParticleFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr uint32_t kCorners = 6;

VkDeviceSize alignPart(VkDeviceSize bytes) {
    return (bytes + 255) / 256 * 256;
}

gpu::GraphicsPipelineDesc
describeDraw(const gpu_scene::GpuScene& scene, VkFormat format, bool isLayer) {
    gpu::GraphicsPipelineDesc desc;
    desc.name = "particles";
    desc.vertexSpirv = render_particle_vert;
    desc.fragmentSpirv = render_particle_frag;
    desc.interface.bindings = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
    desc.interface.pushConstantBytes = sizeof(shader::ParticleDraw);
    desc.interface.sceneLayout = scene.textureLayout();
    desc.colorFormats = {format};
    desc.blend = isLayer ? gpu::Blend::PremultipliedLayer : gpu::Blend::Premultiplied;
    return desc;
}

gpu::GraphicsPipelineDesc describeComposite(VkFormat format) {
    gpu::GraphicsPipelineDesc desc;
    desc.name = "particle composite";
    desc.vertexSpirv = render_sky_vert;
    desc.fragmentSpirv = render_particle_composite_frag;
    desc.interface.bindings.assign(
        1 + shader::kMaxParticleParts, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
    );
    desc.interface.pushConstantBytes = sizeof(uint32_t);
    desc.colorFormats = {format};
    return desc;
}

/// Whether passes can draw on it as it is.
bool isDrawable(const graph::Graph& graph, graph::ImageHandle image) {
    return !graph.resources()[image.resource].imported &&
           graph.describeImage(image).format == kParticleFormat;
}

} // namespace

shader::ParticleDraw ParticleBuffer::upload(const extract::ParticleTables& tables) {
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

const gpu::Pipeline& ParticlePass::findDraw(VkFormat format, bool isLayer) {
    const auto known = mDraws.find({format, isLayer});
    if (known != mDraws.end())
        return known->second;
    return mDraws
        .emplace(
            std::pair(format, isLayer),
            gpu::Pipeline(mDevice, describeDraw(mScene, format, isLayer))
        )
        .first->second;
}

const gpu::Pipeline& ParticlePass::findComposite(VkFormat format) {
    const auto known = mComposites.find(format);
    if (known != mComposites.end())
        return known->second;
    return mComposites.emplace(format, gpu::Pipeline(mDevice, describeComposite(format)))
        .first->second;
}

graph::ImageHandle ParticlePass::declareDraw(
    graph::Graph& graph,
    const std::string& name,
    const ParticleTargets& targets,
    graph::ImageHandle target,
    const shader::ParticleDraw& draw,
    uint32_t count,
    bool isLayer
) {
    struct Data {
        graph::ImageHandle target;
        graph::ImageHandle depth;
    };

    const gpu::Pipeline& pipeline = findDraw(graph.describeImage(target).format, isLayer);
    return graph
        .addPass<Data>(
            name,
            graph::PassKind::Raster,
            [&](graph::PassBuilder& builder, Data& data) {
                data.depth = builder.read(targets.motionDepth, graph::Access::SampledFragment);
                std::optional<graph::ClearColor> clear;
                if (isLayer)
                    clear = graph::ClearColor::floats(0.0f, 0.0f, 0.0f, 1.0f);
                data.target = builder.colorTarget(target, clear);
            },
            [this, &pipeline, draw, count](const Data& data, graph::PassContext& context) {
                gpu::BindingList bindings;
                bindings.sampled(context.resources.view(data.depth), mDevice.nearestSampler());
                context.frame.bind(pipeline, bindings, &draw, sizeof(draw), mScene.textureSet());
                vkCmdSetCullMode(context.commands, VK_CULL_MODE_NONE);
                vkCmdSetFrontFace(context.commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
                vkCmdDraw(context.commands, kCorners, count, 0, 0);
            }
        )
        .target;
}

graph::ImageHandle ParticlePass::declare(
    graph::Graph& graph,
    const extract::ParticleTables& tables,
    ParticleBuffer& buffer,
    const ParticleTargets& targets
) {
    shader::ParticleDraw draw = buffer.upload(tables);
    draw.frame = gpu::splitAddress(targets.frameConstants);
    draw.response = gpu::splitAddress(targets.response);
    const graph::TransientImageDesc desc = graph.describeImage(targets.color);
    draw.jitter =
        math::vec2(-2.0 * targets.jitterPx / math::dvec2(double(desc.width), double(desc.height)));
    const auto count = static_cast<uint32_t>(tables.rows.size());
    draw.lightShare = tables.isInstant ? math::vec2(0.0f) : math::vec2(0.0f, 1.0f);
    if (tables.parts == 1 && !tables.mayOverflow && isDrawable(graph, targets.color))
        return declareDraw(graph, "particles", targets, targets.color, draw, count, false);

    struct Data {
        graph::ImageHandle color;
        std::array<graph::ImageHandle, shader::kMaxParticleParts> parts;
        graph::ImageHandle target;
    };

    std::vector<graph::ImageHandle> layers;
    for (uint32_t part = 0; part < tables.parts; ++part) {
        if (tables.parts > 1)
            draw.lightShare = math::vec2(float(part), float(part + 1)) / float(tables.parts);
        const auto layer =
            graph.createImage("particles", {desc.width, desc.height, kParticleFormat});
        layers.push_back(declareDraw(graph, "particles", targets, layer, draw, count, true));
    }
    const gpu::Pipeline& pipeline = findComposite(desc.format);
    const auto target = graph.createImage("color with particles", desc);
    return graph
        .addPass<Data>(
            "particle composite",
            graph::PassKind::Raster,
            [&](graph::PassBuilder& builder, Data& data) {
                data.color = builder.read(targets.color, graph::Access::SampledFragment);
                for (size_t i = 0; i < data.parts.size(); ++i)
                    data.parts[i] = i < layers.size()
                                        ? builder.read(layers[i], graph::Access::SampledFragment)
                                        : data.parts[0];
                data.target =
                    builder.colorTarget(target, graph::ClearColor::floats(0.0f, 0.0f, 0.0f, 0.0f));
            },
            [this, &pipeline, parts = tables.parts](const Data& data, graph::PassContext& context) {
                gpu::BindingList bindings;
                bindings.sampled(context.resources.view(data.color), mDevice.nearestSampler());
                for (const graph::ImageHandle part : data.parts)
                    bindings.sampled(context.resources.view(part), mDevice.nearestSampler());
                context.frame.bind(pipeline, bindings, &parts, sizeof(parts));
                vkCmdSetCullMode(context.commands, VK_CULL_MODE_NONE);
                vkCmdSetFrontFace(context.commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
                vkCmdDraw(context.commands, 3, 1, 0, 0);
            }
        )
        .target;
}

} // namespace shutter::render
