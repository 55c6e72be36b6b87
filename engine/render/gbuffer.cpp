// SPDX-License-Identifier: MIT
#include "engine/render/gbuffer.h"

#include "spirv/render/gbuffer.frag.h"
#include "spirv/render/gbuffer.vert.h"
#include "spirv/render/gbuffer_masked_samples.frag.h"
#include "spirv/render/gbuffer_masked_samples_normals.frag.h"
#include "spirv/render/gbuffer_normals.frag.h"
#include "spirv/render/gbuffer_samples.frag.h"
#include "spirv/render/gbuffer_samples_normals.frag.h"
#include "spirv/render/sky.frag.h"
#include "spirv/render/sky.vert.h"
#include "spirv/render/sky_normals.frag.h"
#include "spirv/render/sky_samples.frag.h"
#include "spirv/render/sky_samples_normals.frag.h"

#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "shaders/render/split_samples_shared.h"

#include <utility>

namespace shutter::render {

namespace {

constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

static_assert(extract::kMaxEntities < 1u << shader::kSampleRowBits);

using Variant = GBufferPass::Variant;

/// kBlend of gbuffer.frag.
uint32_t blendConstantOf(Variant variant) {
    if (variant == Variant::Blended)
        return 1;
    return variant == Variant::Premultiplied ? 2 : 0;
}

/// Code of a fragment shader for each kind of target.
struct FragmentShaders {
    std::span<const uint32_t> plain;
    std::span<const uint32_t> withNormals;
    std::span<const uint32_t> samples;
    std::span<const uint32_t> samplesWithNormals;

    [[nodiscard]] std::span<const uint32_t> choose(const GBufferPass::Targets& targets) const {
        if (targets.samples > 1)
            return targets.writesNormals ? samplesWithNormals : samples;
        return targets.writesNormals ? withNormals : plain;
    }
};

gpu::GraphicsPipelineDesc describeGeometry(
    const gpu_scene::GpuScene& scene,
    Variant variant,
    bool moves,
    const GBufferPass::Targets& targets
) {
    FragmentShaders shaders{
        render_gbuffer_frag,
        render_gbuffer_normals_frag,
        render_gbuffer_samples_frag,
        render_gbuffer_samples_normals_frag};
    if (variant == Variant::Masked) {
        shaders.samples = render_gbuffer_masked_samples_frag;
        shaders.samplesWithNormals = render_gbuffer_masked_samples_normals_frag;
    }
    gpu::GraphicsPipelineDesc desc;
    desc.name = "G-buffer";
    desc.vertexSpirv = render_gbuffer_vert;
    desc.fragmentSpirv = shaders.choose(targets);
    desc.interface.pushConstantBytes = sizeof(shader::DrawConstants);
    desc.interface.sceneLayout = scene.textureLayout();
    desc.specialization = {
        variant == Variant::Masked, blendConstantOf(variant), moves, targets.slots};
    if (targets.samples > 1)
        desc.colorFormats = {kColorFormat, kSampleSurfaceFormat};
    else
        desc.colorFormats = {kColorFormat, kMotionDepthFormat, kEntityIdFormat};
    if (targets.writesNormals)
        desc.colorFormats.push_back(targets.samples > 1 ? kSampleNormalFormat : kNormalFormat);
    desc.depthFormat = kDepthFormat;
    desc.samples = targets.samples;
    desc.depthWrite = blendConstantOf(variant) == 0;
    if (variant == Variant::Blended)
        desc.blend = gpu::Blend::Over;
    if (variant == Variant::Premultiplied)
        desc.blend = gpu::Blend::Premultiplied;
    return desc;
}

gpu::GraphicsPipelineDesc
describeSky(const gpu_scene::GpuScene& scene, const GBufferPass::Targets& targets) {
    gpu::GraphicsPipelineDesc desc = describeGeometry(scene, Variant::Opaque, false, targets);
    desc.name = "sky";
    desc.vertexSpirv = render_sky_vert;
    desc.fragmentSpirv =
        FragmentShaders{
            render_sky_frag,
            render_sky_normals_frag,
            render_sky_samples_frag,
            render_sky_samples_normals_frag}
            .choose(targets);
    desc.specialization = {};
    desc.depthCompare = VK_COMPARE_OP_EQUAL; // where the depth is still the cleared, infinite one
    desc.depthWrite = false;
    return desc;
}

Variant variantOf(const extract::SceneLayout::GeometryInfo& info) {
    if (info.alphaMode == scene::AlphaMode::Mask)
        return Variant::Masked;
    if (info.alphaMode != scene::AlphaMode::Blend)
        return Variant::Opaque;
    return info.premultiplies ? Variant::Premultiplied : Variant::Blended;
}

bool maySample(const gpu::Device& device) {
    if (!device.info().interpolatesAnywhere)
        return false;
    for (const VkFormat format :
         {kColorFormat, kSampleSurfaceFormat, kSampleNormalFormat, kDepthFormat})
        if (!device.canDrawSamples(format, shader::kSampleCount))
            return false;
    return true;
}

/// Records the draws of one frame.
class Recorder {
  public:
    Recorder(
        gpu::Frame& commands,
        const extract::ExtractedFrame& frame,
        const gpu_scene::GpuScene& scene,
        VkDeviceAddress constants
    )
        : mCommands(commands), mFrame(frame), mScene(scene),
          mConstants(gpu::splitAddress(constants)) {}

    /// Binds the pipeline unless it is bound.
    void bind(const gpu::Pipeline& pipeline) {
        if (std::exchange(mBound, &pipeline) != &pipeline)
            mCommands.bind(pipeline, {}, nullptr, 0, mScene.textureSet());
    }

    void draw(const GBufferPass::Variants& variants, const extract::DrawItem& item) {
        const extract::SceneLayout::GeometryInfo& info = mScene.layout().geometries[item.geometry];
        const GBufferPass::Pipelines& pipelines = *variants[size_t(variantOf(info))];
        const bool moves = mFrame.entities[item.entity].motion != shader::kNoMotion;
        bind(moves ? pipelines.moving : pipelines.still);
        push(item.entity, item.geometryRow);
        set(item.doubleSided, item.mirrored);
        vkCmdDrawIndexed(mCommands.commands(), info.indexCount, 1, info.firstIndex, 0, 0);
    }

    /// The bound pipeline's, without buffers.
    void drawScreen() {
        push(0, 0);
        set(true, false);
        vkCmdDraw(mCommands.commands(), 3, 1, 0, 0);
    }

  private:
    void push(uint32_t entity, uint32_t geometry) const {
        const shader::DrawConstants draw{mConstants, entity, geometry};
        vkCmdPushConstants(
            mCommands.commands(), mBound->layout(), mBound->stages(), 0, sizeof(draw), &draw
        );
    }

    /// Sets culling and winding if they differ from the last call.
    void set(bool doubleSided, bool mirrored) {
        const Sides sides{doubleSided, mirrored};
        if (std::exchange(mSides, sides) == sides)
            return;
        const VkCommandBuffer commands = mCommands.commands();
        vkCmdSetCullMode(commands, doubleSided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
        vkCmdSetFrontFace(
            commands, mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE
        );
    }

    struct Sides {
        bool doubleSided = false;
        bool mirrored = false;

        bool operator==(const Sides&) const = default;
    };

    gpu::Frame& mCommands;
    const extract::ExtractedFrame& mFrame;
    const gpu_scene::GpuScene& mScene;
    math::uvec2 mConstants;
    const gpu::Pipeline* mBound = nullptr;
    std::optional<Sides> mSides; ///< that were set last: they outlast a change of pipeline
};

} // namespace

GBufferPass::Pipelines::Pipelines(
    gpu::Device& device, const gpu_scene::GpuScene& scene, Variant variant, const Targets& targets
)
    : still(device, describeGeometry(scene, variant, false, targets)),
      moving(device, describeGeometry(scene, variant, true, targets)) {}

GBufferPass::GBufferPass(gpu::Device& device, const gpu_scene::GpuScene& scene)
    : mDevice(device), mScene(scene), mSplit(device), mMaySample(maySample(device)) {}

const GBufferPass::Drawers& GBufferPass::findDrawers(const Targets& targets) {
    const auto [found, isNew] = mDrawers.try_emplace(targets);
    Drawers& drawers = found->second;
    if (!isNew)
        return drawers;
    drawers.sky = gpu::Pipeline(mDevice, describeSky(mScene, targets));
    for (const extract::SceneLayout::GeometryInfo& info : mScene.layout().geometries) {
        const Variant variant = variantOf(info);
        if (auto& pipelines = drawers.variants[size_t(variant)]; !pipelines)
            pipelines.emplace(mDevice, mScene, variant, targets);
    }
    return drawers;
}

GBuffer GBufferPass::declare(graph::Graph& graph, const std::string& name, const Source& source) {
    const extract::ExtractedFrame& frame = source.frame;
    const gpu_scene::GpuScene& scene = source.scene;
    const bool isSampled = source.samplesEdges && mMaySample;
    const uint32_t samples = isSampled ? shader::kSampleCount : 1;
    const Drawers& drawers = findDrawers({source.slots, samples, source.writesNormals});
    const auto create = [&](const char* label, VkFormat format) {
        return graph.createImage(
            label,
            {static_cast<uint32_t>(frame.constants.sizePx.x),
             static_cast<uint32_t>(frame.constants.sizePx.y),
             format,
             samples}
        );
    };
    GBuffer targets;
    SampleSplit::Samples sampled;
    targets.color = create("color", kColorFormat);
    if (isSampled) {
        sampled.surface = create("sample surfaces", kSampleSurfaceFormat);
        if (source.writesNormals)
            sampled.normal = create("sample normals", kSampleNormalFormat);
    } else {
        if (source.writesNormals)
            targets.normal = create("normal", kNormalFormat);
        targets.motionDepth = create("motion depth", kMotionDepthFormat);
        targets.entityId = create("entity id", kEntityIdFormat);
    }
    const auto depth = create("depth buffer", kDepthFormat);

    struct Data {};

    graph.addPass<Data>(
        name,
        graph::PassKind::Raster,
        [&](graph::PassBuilder& builder, Data&) {
            for (const graph::BufferHandle buffer : source.reads)
                if (buffer.isValid())
                    builder.read(buffer, graph::Access::ShaderRead);
            const auto zero = graph::ClearColor::floats(0.0f, 0.0f, 0.0f, 0.0f);
            const auto none = graph::ClearColor::uints(shader::kNoEntity);
            targets.color = builder.colorTarget(targets.color, zero);
            if (isSampled) {
                sampled.surface = builder.colorTarget(sampled.surface, none);
            } else {
                targets.motionDepth = builder.colorTarget(targets.motionDepth, zero);
                targets.entityId = builder.colorTarget(targets.entityId, none);
            }
            graph::ImageHandle& normal = isSampled ? sampled.normal : targets.normal;
            if (normal.isValid())
                normal = builder.colorTarget(normal, isSampled ? none : zero);
            (void)builder.depthTarget(depth, 0.0f);
        },
        [&drawers, &frame, &scene, taken = source.taken, constants = source.frameConstants](
            const Data&, graph::PassContext& context
        ) {
            Recorder recorder(context.frame, frame, scene, constants);
            vkCmdBindIndexBuffer(context.commands, scene.indexBuffer(), 0, VK_INDEX_TYPE_UINT32);
            for (const bool masked : {false, true})
                frame.opaque.forEach([&](const extract::DrawItem& item) {
                    if ((item.alphaMode == scene::AlphaMode::Mask) == masked)
                        recorder.draw(drawers.variants, item);
                });
            recorder.bind(drawers.sky);
            recorder.drawScreen();
            frame.blended.forEach([&](const extract::DrawItem& item) {
                if (!extract::isTaken(taken, item.entity))
                    recorder.draw(drawers.variants, item);
            });
        }
    );
    if (!isSampled)
        return targets;
    sampled.color = targets.color;
    return mSplit.declare(
        graph, sampled, {source.keepsEdges, source.confusion, !frame.blended.empty()}
    );
}

} // namespace shutter::render
