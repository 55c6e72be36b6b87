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

/// Copies the colour as it is before the blur.
graph::ImageHandle
addKeepColor(graph::Graph& graph, graph::ImageHandle color, graph::ImageHandle kept) {
    struct Data {
        graph::ImageHandle source;
        graph::ImageHandle target;
    };

    return graph
        .addPass<Data>(
            "keep colour",
            graph::PassKind::Transfer,
            [&](graph::PassBuilder& builder, Data& data) {
                data.source = builder.read(color, Access::TransferRead);
                data.target = builder.write(kept, Access::TransferWrite);
            },
            [](const Data& data, graph::PassContext& context) {
                copyWhole(context, data.source, data.target);
            }
        )
        .target;
}

bool hasSize(const gpu::Image& image, glm::uvec2 sizePx) {
    return image.desc().width == sizePx.x && image.desc().height == sizePx.y;
}

} // namespace

SurfaceLayers::SurfaceLayers(gpu::Device& device)
    : mDevice(device), mSampler(device.nearestSampler()),
      mPack(
          device,
          describePass(
              "pack surface", motion_blur_resolved_surface_comp, {kSampled, kSampled, kStorage}
          )
      ) {}

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
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT; // for those who want to see it
    desc.format = kColorFormat;
    kept.color = gpu::Image(mDevice, "kept colour", desc);
    desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
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
    if (keep) {
        mNewest = 1 - mNewest;
        Kept& kept = mKept.at(mNewest);
        resize(kept, params.sizePx);
        kept.hasContents = true;
        const SurfaceLayer target = importKept(graph, kept, VK_IMAGE_LAYOUT_UNDEFINED);
        graph.markOutput(addKeepColor(graph, inputs.color, target.color));
        outputs.raster.surface = addPack(graph, inputs, target.surface, params);
        graph.markOutput(outputs.raster.surface);
    } else {
        // What was kept is a frame older from now on.
        mKept.at(mNewest).hasContents = false;
        const glm::uvec2 size = params.sizePx;
        outputs.raster.surface = addPack(
            graph, inputs, graph.createImage("surface", {size.x, size.y, kSurfaceFormat}), params
        );
    }
    return outputs;
}

graph::ImageHandle SurfaceLayers::addPack(
    graph::Graph& graph,
    const MotionBlurInputs& inputs,
    graph::ImageHandle target,
    const PassParams& params
) const {
    struct Data {
        graph::ImageHandle surface;
    };

    return graph
        .addPass<Data>(
            "pack surface",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                builder.read(inputs.motionDepth, Access::SampledCompute);
                builder.read(inputs.entityId, Access::SampledCompute);
                data.surface = builder.write(target, Access::StorageWrite);
            },
            [this, inputs, params](const Data& data, graph::PassContext& context) {
                const graph::PassResources& resources = context.resources;
                gpu::BindingList bindings;
                bindings.sampled(resources.view(inputs.motionDepth), mSampler)
                    .sampled(resources.view(inputs.entityId), mSampler)
                    .storage(resources.image(data.surface));
                dispatchPixels(context, mPack.get(), bindings, params, params.sizePx);
            }
        )
        .surface;
}

} // namespace shutter::motion_blur
