// SPDX-License-Identifier: MIT
#include "modules/glass/blended_layer_pass.h"

#include "spirv/glass/blended_layer.frag.h"
#include "spirv/glass/blended_layer.vert.h"
#include "spirv/glass/blended_layer_reset.frag.h"
#include "spirv/render/sky.vert.h"

#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"

#include <span>

namespace shutter::glass {

namespace {

constexpr VkFormat kLayerFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

gpu::GraphicsPipelineDesc describeLayer(const char* name) {
    gpu::GraphicsPipelineDesc desc;
    desc.name = name;
    desc.colorFormats = {kLayerFormat, kLayerFormat};
    desc.depthWrite = false;
    return desc;
}

gpu::GraphicsPipelineDesc describeDraw(const gpu_scene::GpuScene& scene, bool readsInstants) {
    gpu::GraphicsPipelineDesc desc = describeLayer("blended layer");
    desc.vertexSpirv = glass_blended_layer_vert;
    desc.fragmentSpirv = glass_blended_layer_frag;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    desc.interface.pushConstantBytes = sizeof(shader::LayerDraw);
    desc.interface.sceneLayout = scene.textureLayout();
    desc.specialization = {readsInstants ? 1u : 0u};
    desc.blend = gpu::Blend::Under;
    return desc;
}

gpu::GraphicsPipelineDesc describeReset() {
    gpu::GraphicsPipelineDesc desc = describeLayer("reset blended layer");
    desc.vertexSpirv = render_sky_vert;
    desc.fragmentSpirv = glass_blended_layer_reset_frag;
    desc.blend = gpu::Blend::AlphaOnly;
    return desc;
}

} // namespace

/// Records the draws of one part.
class BlendedLayerPass::Recorder {
  public:
    Recorder(
        const BlendedLayerPass& pass,
        graph::PassContext& context,
        const BlendedLayer& layer,
        const gpu::BindingList& bindings,
        VkDeviceAddress frameConstants,
        uint32_t slot
    )
        : mPass(pass), mContext(context), mLayer(layer), mBindings(bindings),
          mTables(pass.mTables.at(slot).address()) {
        mDraw.frame = gpu::splitAddress(frameConstants);
    }

    void record(uint32_t part, const math::uvec2& pictureSize, bool isPerspective) {
        mDraw.isPerspective = isPerspective ? 1 : 0;
        const VkCommandBuffer commands = mContext.commands;
        vkCmdBindIndexBuffer(commands, mPass.mScene.indexBuffer(), 0, VK_INDEX_TYPE_UINT32);
        // The picture's own, of which the targets are a rectangle.
        VkViewport viewport{};
        viewport.x = -float(mLayer.originPx.x);
        viewport.y = -float(mLayer.originPx.y);
        viewport.width = float(pictureSize.x);
        viewport.height = float(pictureSize.y);
        viewport.maxDepth = 1.0f;
        vkCmdSetViewport(commands, 0, 1, &viewport);
        // Images are larger than the rectangle, data that is read is not.
        const VkRect2D scissor{{0, 0}, {mLayer.sizePx.x, mLayer.sizePx.y}};
        vkCmdSetScissor(commands, 0, 1, &scissor);
        const shader::InstantSurfaces surfaces = mLayer.surfaces();
        bool isFirst = true;
        for (uint32_t i = 0; i < surfaces.instantCount; ++i) {
            if (shader::surfacePartOf(surfaces, i) != part)
                continue;
            if (!isFirst)
                reset();
            isFirst = false;
            drawInstant(i);
        }
    }

  private:
    void reset() {
        mContext.frame.bind(mPass.mReset, {}, nullptr, 0);
        vkCmdSetCullMode(mContext.commands, VK_CULL_MODE_NONE);
        vkCmdDraw(mContext.commands, 3, 1, 0, 0);
    }

    void drawInstant(uint32_t instant) {
        const gpu::Pipeline& pipeline = mPass.mDraw[mLayer.readsInstants ? 1 : 0];
        mContext.frame.bind(pipeline, mBindings, &mDraw, sizeof(mDraw), mPass.mScene.textureSet());
        mDraw.index = instant;
        mDraw.instant = gpu::splitAddress(mTables + instant * sizeof(shader::LayerInstant));
        const VkDeviceAddress places =
            mTables + mLayer.instants.size() * sizeof(shader::LayerInstant);
        for (const LayerItem& item : mLayer.items) {
            mDraw.entity = item.draw.entity;
            mDraw.geometry = item.draw.geometryRow;
            mDraw.place = gpu::splitAddress(
                places + (item.firstPlace + instant) * sizeof(shader::LayerPlace)
            );
            draw(pipeline, item.draw);
        }
    }

    void draw(const gpu::Pipeline& pipeline, const extract::DrawItem& item) const {
        const VkCommandBuffer commands = mContext.commands;
        const auto& info = mPass.mScene.layout().geometries[item.geometry];
        vkCmdPushConstants(
            commands, pipeline.layout(), pipeline.stages(), 0, sizeof(mDraw), &mDraw
        );
        vkCmdSetCullMode(commands, item.doubleSided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
        vkCmdSetFrontFace(
            commands, item.mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE
        );
        // The raster draws a mesh's triangles over one another in their order; here each is drawn
        // behind those before it.
        vkCmdDrawIndexed(commands, info.indexCount, 1, info.firstReversed, 0, 0);
    }

    const BlendedLayerPass& mPass;
    graph::PassContext& mContext;
    const BlendedLayer& mLayer;
    const gpu::BindingList& mBindings;
    VkDeviceAddress mTables;
    shader::LayerDraw mDraw{};
};

void BlendedLayerPass::preparePipelines() {
    if (mReset.handle())
        return;
    for (const bool readsInstants : {false, true})
        mDraw[readsInstants ? 1 : 0] = gpu::Pipeline(mDevice, describeDraw(mScene, readsInstants));
    mReset = gpu::Pipeline(mDevice, describeReset());
}

void BlendedLayerPass::upload(const BlendedLayer& layer, uint32_t slot) {
    gpu::Buffer& tables = mTables.at(slot);
    const std::span<const shader::LayerInstant> instants(layer.instants);
    const std::span<const shader::LayerPlace> places(layer.places);
    const VkDeviceSize bytes = instants.size_bytes() + places.size_bytes();
    if (!tables || tables.bytes() < bytes)
        tables = gpu::Buffer(
            mDevice,
            "blended layer",
            bytes + bytes / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Stream
        );
    tables.write(instants, 0);
    tables.write(places, instants.size_bytes());
}

render::OverlayPart BlendedLayerPass::declare(
    const render::OverlayContext& context,
    const BlendedLayer& layer,
    graph::BufferHandle surfaces,
    uint32_t part
) {
    preparePipelines();
    if (part == 0)
        upload(layer, context.slot);
    graph::Graph& graph = context.graph;
    render::OverlayPart targets;
    const math::uvec2 allocated = shader::sizeInSteps(layer.sizePx);
    const graph::TransientImageDesc size{allocated.x, allocated.y, kLayerFormat};
    targets.color = graph.createImage("blended color", size);
    targets.opacity = graph.createImage("blended opacity", size);
    const graph::BufferHandle shapes = context.shapes.buffer;
    const graph::ImageHandle motionDepth = context.motionDepth;
    const math::uvec2 pictureSize(context.view.width, context.view.height);
    const bool isPerspective = context.frame.constants.pixelFootprint.x > 0.0f;

    struct Data {};

    graph.addPass<Data>(
        "blended layer",
        graph::PassKind::Raster,
        [&](graph::PassBuilder& builder, Data&) {
            for (const graph::BufferHandle buffer : {shapes, surfaces})
                if (buffer.isValid())
                    builder.read(buffer, graph::Access::ShaderRead);
            for (const graph::BufferHandle buffer : context.shading)
                builder.read(buffer, graph::Access::ShaderRead);
            builder.read(motionDepth, graph::Access::SampledFragment);
            const auto clear = graph::ClearColor::floats(0.0f, 0.0f, 0.0f, 1.0f);
            targets.color = builder.colorTarget(targets.color, clear);
            targets.opacity = builder.colorTarget(targets.opacity, clear);
        },
        [this,
         &layer,
         surfaces,
         motionDepth,
         pictureSize,
         isPerspective,
         part,
         slot = context.slot,
         constants = context.frameConstants](const Data&, graph::PassContext& pass) {
            gpu::BindingList bindings;
            bindings.sampled(pass.resources.view(motionDepth), mDevice.nearestSampler());
            if (surfaces.isValid())
                bindings.buffer(pass.resources.buffer(surfaces));
            else // not read
                bindings.buffer(mTables.at(slot).handle());
            Recorder(*this, pass, layer, bindings, constants, slot)
                .record(part, pictureSize, isPerspective);
        }
    );
    return targets;
}

} // namespace shutter::glass
