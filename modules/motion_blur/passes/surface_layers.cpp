// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/surface_layers.h"

#include "spirv/motion_blur/resolved_surface.comp.h"

#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

constexpr VkFormat kColorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat kSurfaceFormat = VK_FORMAT_R32G32_SFLOAT;
constexpr VkImageLayout kKeptLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

gpu::ComputePipelineDesc describePack(bool keep) {
    gpu::ComputePipelineDesc desc = describePass(
        keep ? "pack and keep surface" : "pack surface",
        motion_blur_resolved_surface_comp,
        {kSampled, kSampled, kSampled, kStorage, kStorage}
    );
    desc.specialization = {keep ? 1u : 0u};
    return desc;
}

bool hasSize(const gpu::Image& image, glm::uvec2 sizePx) {
    return image.desc().width == sizePx.x && image.desc().height == sizePx.y;
}

} // namespace

SurfaceLayers::SurfaceLayers(gpu::Device& device)
    : mDevice(device), mSampler(device.nearestSampler()), mPack(device, describePack(false)),
      mPackAndKeep(device, describePack(true)) {}

bool SurfaceLayers::holds(glm::uvec2 sizePx) const {
    const Kept& kept = mKept.at(mNewest);
    return kept.hasContents && hasSize(kept.color, sizePx);
}

uint64_t SurfaceLayers::keptBytes() const {
    uint64_t bytes = 0;
    for (const Kept& kept : mKept)
        for (const gpu::Image* image : {&kept.color, &kept.surface})
            if (image->handle())
                bytes += uint64_t(image->desc().width) * image->desc().height *
                         gpu::texelBytes(image->desc().format);
    return bytes;
}

void SurfaceLayers::resize(Kept& kept, glm::uvec2 sizePx) {
    if (kept.color.handle() && hasSize(kept.color, sizePx))
        return;
    gpu::ImageDesc desc;
    desc.width = sizePx.x;
    desc.height = sizePx.y;
    desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT; // for those who want to see it
    desc.format = kColorFormat;
    kept.color = gpu::Image(mDevice, "kept colour", desc);
    desc.format = kSurfaceFormat;
    kept.surface = gpu::Image(mDevice, "kept surface", desc);
}

SurfaceLayer
SurfaceLayers::importKept(graph::Graph& graph, const Kept& kept, VkImageLayout layout) {
    return {
        graph.importImage("kept colour", kept.color, layout, kKeptLayout),
        graph.importImage("kept surface", kept.surface, layout, kKeptLayout)};
}

SurfaceLayersOutputs SurfaceLayers::add(
    graph::Graph& graph,
    const MotionBlurInputs& inputs,
    const PassParams& params,
    bool wantLast,
    bool keep
) {
    SurfaceLayersOutputs outputs;
    outputs.raster.color = inputs.color;
    if (wantLast)
        outputs.last = importKept(graph, mKept.at(mNewest), kKeptLayout);
    SurfaceLayer target;
    if (keep) {
        mNewest = 1 - mNewest;
        Kept& kept = mKept.at(mNewest);
        resize(kept, params.sizePx);
        kept.hasContents = true;
        target = importKept(graph, kept, VK_IMAGE_LAYOUT_UNDEFINED);
    } else {
        // What was kept is a frame older from now on.
        mKept.at(mNewest).hasContents = false;
        target = {
            graph.createImage("no kept colour", {1, 1, kColorFormat}),
            graph.createImage("surface", {params.sizePx.x, params.sizePx.y, kSurfaceFormat})};
    }
    const SurfaceLayer& packed = graph.addPass<SurfaceLayer>(
        keep ? "pack and keep surface" : "pack surface",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, SurfaceLayer& data) {
            builder.read(inputs.color, Access::SampledCompute);
            builder.read(inputs.motionDepth, Access::SampledCompute);
            builder.read(inputs.entityId, Access::SampledCompute);
            data.surface = builder.write(target.surface, Access::StorageWrite);
            data.color = builder.write(target.color, Access::StorageWrite);
        },
        [this, keep, inputs, params](const SurfaceLayer& data, graph::PassContext& context) {
            const graph::PassResources& resources = context.resources;
            gpu::BindingList bindings;
            for (const graph::ImageHandle image :
                 {inputs.color, inputs.motionDepth, inputs.entityId})
                bindings.sampled(resources.view(image), mSampler);
            bindings.storage(resources.image(data.surface)).storage(resources.image(data.color));
            const gpu::LazyPipeline& pipeline = keep ? mPackAndKeep : mPack;
            dispatchPixels(context, pipeline.get(), bindings, params, params.sizePx);
        }
    );
    outputs.raster.surface = packed.surface;
    if (keep) {
        graph.markOutput(packed.surface);
        graph.markOutput(packed.color);
    }
    return outputs;
}

} // namespace shutter::motion_blur
