// SPDX-License-Identifier: MIT
#include "engine/render/gbuffer.h"

#include "spirv/render/gbuffer.frag.h"
#include "spirv/render/gbuffer.vert.h"
#include "spirv/render/sky.frag.h"
#include "spirv/render/sky.vert.h"

#include "engine/gpu/frame.h"
#include "engine/graph/execute.h"

namespace shutter::render {

namespace {

constexpr VkFormat kColorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat kNormalFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat kMotionDepthFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kMeshIdFormat = VK_FORMAT_R32_UINT;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

enum class Variant { Opaque, Masked, Blended };

gpu::GraphicsPipelineDesc describeGeometry(const GpuScene& scene, Variant variant) {
    gpu::GraphicsPipelineDesc desc;
    desc.name = "G-buffer";
    desc.vertexSpirv = render_gbuffer_vert;
    desc.fragmentSpirv = render_gbuffer_frag;
    desc.interface.pushConstantBytes = sizeof(shader::DrawConstants);
    desc.interface.sceneLayout = scene.textureLayout();
    desc.specialization = {variant == Variant::Masked ? 1u : 0u, variant == Variant::Blended};
    desc.colorFormats = {kColorFormat, kNormalFormat, kMotionDepthFormat, kMeshIdFormat};
    desc.depthFormat = kDepthFormat;
    desc.depthWrite = variant != Variant::Blended;
    desc.blendFirstOnly = variant == Variant::Blended;
    return desc;
}

gpu::GraphicsPipelineDesc describeSky(const GpuScene& scene) {
    gpu::GraphicsPipelineDesc desc = describeGeometry(scene, Variant::Opaque);
    desc.name = "sky";
    desc.vertexSpirv = render_sky_vert;
    desc.fragmentSpirv = render_sky_frag;
    desc.specialization = {};
    desc.depthCompare = VK_COMPARE_OP_EQUAL; // where the cleared, infinite depth still stands
    desc.depthWrite = false;
    return desc;
}

/// Records the draws of one frame.
struct Recorder {
    gpu::Frame& frame;
    const GpuScene& scene;
    math::uvec2 constants;

    void bind(const gpu::Pipeline& pipeline) const {
        frame.bind(pipeline, {}, nullptr, 0, scene.textureSet());
    }

    void push(const gpu::Pipeline& pipeline, uint32_t entity, uint32_t geometry) const {
        const shader::DrawConstants draw{constants, entity, geometry};
        vkCmdPushConstants(
            frame.commands(), pipeline.layout(), pipeline.stages(), 0, sizeof(draw), &draw
        );
    }

    void draw(const gpu::Pipeline& pipeline, const DrawItem& item) const {
        const SceneLayout::GeometryInfo& info = scene.layout().geometries[item.geometry];
        const VkCommandBuffer commands = frame.commands();
        push(pipeline, item.entity, item.geometryRow);
        vkCmdSetCullMode(commands, item.doubleSided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
        vkCmdSetFrontFace(
            commands, item.mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE
        );
        vkCmdDrawIndexed(commands, info.indexCount, 1, info.firstIndex, 0, 0);
    }
};

} // namespace

GBufferPass::GBufferPass(gpu::Device& device, const GpuScene& scene)
    : mOpaque(device, describeGeometry(scene, Variant::Opaque)),
      mMasked(device, describeGeometry(scene, Variant::Masked)),
      mBlended(device, describeGeometry(scene, Variant::Blended)),
      mSky(device, describeSky(scene)) {}

GBuffer GBufferPass::declare(
    graph::Graph& graph,
    const ExtractedFrame& frame,
    const GpuScene& scene,
    graph::BufferHandle shapes,
    VkDeviceAddress frameConstants
) const {
    const auto width = static_cast<uint32_t>(frame.constants.sizePx.x);
    const auto height = static_cast<uint32_t>(frame.constants.sizePx.y);
    GBuffer targets;
    targets.color = graph.createImage("color", {width, height, kColorFormat});
    targets.normal = graph.createImage("normal", {width, height, kNormalFormat});
    targets.motionDepth = graph.createImage("motion depth", {width, height, kMotionDepthFormat});
    targets.meshId = graph.createImage("mesh id", {width, height, kMeshIdFormat});
    const auto depth = graph.createImage("depth buffer", {width, height, kDepthFormat});

    struct Data {};

    graph.addPass<Data>(
        "G-buffer",
        graph::PassKind::Raster,
        [&](graph::PassBuilder& builder, Data&) {
            if (shapes.isValid())
                builder.read(shapes, graph::Access::ShaderRead);
            const auto zero = graph::ClearColor::floats(0.0f, 0.0f, 0.0f, 0.0f);
            targets.color = builder.colorTarget(targets.color, zero);
            targets.normal = builder.colorTarget(targets.normal, zero);
            targets.motionDepth = builder.colorTarget(targets.motionDepth, zero);
            targets.meshId =
                builder.colorTarget(targets.meshId, graph::ClearColor::uints(shader::kNoEntity));
            (void)builder.depthTarget(depth, 0.0f);
        },
        [this, &frame, &scene, frameConstants](const Data&, graph::PassContext& context) {
            const Recorder recorder{context.frame, scene, splitAddress(frameConstants)};
            vkCmdBindIndexBuffer(context.commands, scene.indexBuffer(), 0, VK_INDEX_TYPE_UINT32);
            for (const bool masked : {false, true}) {
                const gpu::Pipeline& pipeline = masked ? mMasked : mOpaque;
                bool bound = false;
                for (const DrawItem& item : frame.opaque) {
                    if ((item.alphaMode == scene::AlphaMode::Mask) != masked)
                        continue;
                    if (!bound)
                        recorder.bind(pipeline);
                    bound = true;
                    recorder.draw(pipeline, item);
                }
            }
            recorder.bind(mSky);
            recorder.push(mSky, 0, 0);
            vkCmdSetCullMode(context.commands, VK_CULL_MODE_NONE);
            vkCmdSetFrontFace(context.commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
            vkCmdDraw(context.commands, 3, 1, 0, 0);
            if (frame.blended.empty())
                return;
            recorder.bind(mBlended);
            for (const DrawItem& item : frame.blended)
                recorder.draw(mBlended, item);
        }
    );
    return targets;
}

} // namespace shutter::render
