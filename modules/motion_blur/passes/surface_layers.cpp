// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/surface_layers.h"

#include "spirv/motion_blur/resolved_surface.comp.h"
#include "spirv/motion_blur/resolved_surface_kept.comp.h"

#include "modules/motion_blur/instant_motions.h"
#include "modules/motion_blur/passes/dispatch.h"

#include <array>

namespace shutter::motion_blur {

namespace {

using graph::Access;

constexpr VkFormat kSurfaceFormat = VK_FORMAT_R32G32_UINT;
constexpr VkImageLayout kKeptLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

gpu::ComputePipelineDesc describePack(bool skipsStill) {
    gpu::ComputePipelineDesc desc = describePass(
        "pack surface", motion_blur_resolved_surface_comp, {kSampled, kSampled, kStorage}
    );
    desc.specialization = {skipsStill ? 1u : 0u};
    return desc;
}

gpu::ComputePipelineDesc describePackKept() {
    gpu::ComputePipelineDesc desc = describePass(
        "pack surface",
        motion_blur_resolved_surface_kept_comp,
        {kSampled, kSampled, kStorage, kSampled, kStorage}
    );
    desc.specialization = {1u};
    return desc;
}

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

graph::ImageHandle createSurface(graph::Graph& graph, const PassParams& params) {
    return graph.createImage("surface", {params.sizePx.x, params.sizePx.y, kSurfaceFormat});
}

SurfaceLayer
importRaster(graph::Graph& graph, const RasterHistory::Raster& raster, VkImageLayout layout) {
    return {
        graph.importImage("kept colour", raster.color, layout, kKeptLayout),
        graph.importImage("kept surface", raster.surface, layout, kKeptLayout)};
}

} // namespace

SurfaceLayers::SurfaceLayers(gpu::Device& device)
    : mKeepsByTransfer(isSoftware(device)), mSampler(device.nearestSampler()),
      mPack(device, describePack(true)), mPackKept(device, describePackKept()),
      mPackWhole(device, describePack(false)) {}

SurfaceLayersOutputs SurfaceLayers::add(
    graph::Graph& graph, const MotionBlurInputs& inputs, const PassParams& params, bool wantLast
) const {
    RasterHistory* const history = inputs.instantMotions->history;
    SurfaceLayersOutputs outputs;
    outputs.raster.color = inputs.color;
    const auto& lent = inputs.instantMotions->lent;
    if (wantLast && lent)
        outputs.last = {
            lent->color,
            addPack(
                graph,
                mPack,
                lent->motionDepth,
                lent->entityId,
                createSurface(graph, params),
                params
            )};
    else if (wantLast)
        outputs.last = importRaster(graph, history->newest(), kKeptLayout);
    if (history && inputs.instantMotions->keepsRaster) {
        const SurfaceLayer target =
            importRaster(graph, history->turn(params.sizePx), VK_IMAGE_LAYOUT_UNDEFINED);
        if (mKeepsByTransfer)
            outputs.raster = {
                addKeepColor(graph, inputs.color, target.color),
                addPack(graph, mPack, inputs.motionDepth, inputs.entityId, target.surface, params)};
        else
            outputs.raster = addPackKept(graph, inputs, target, params);
        graph.markOutput(outputs.raster.color);
        graph.markOutput(outputs.raster.surface);
    } else {
        outputs.raster.surface = addPack(
            graph, mPack, inputs.motionDepth, inputs.entityId, createSurface(graph, params), params
        );
    }
    if (const auto& second = inputs.instantMotions->second)
        outputs.second = {
            second->color,
            addPack(
                graph,
                mPackWhole,
                second->motionDepth,
                second->entityId,
                createSurface(graph, params),
                params
            )};
    return outputs;
}

SurfaceLayer SurfaceLayers::addPackKept(
    graph::Graph& graph,
    const MotionBlurInputs& inputs,
    const SurfaceLayer& target,
    const PassParams& params
) const {
    struct Data {
        std::array<graph::ImageHandle, 3> in; ///< motion and depth, ids, colour
        SurfaceLayer kept;
    };

    return graph
        .addPass<Data>(
            "pack surface",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                data.in = {inputs.motionDepth, inputs.entityId, inputs.color};
                for (const graph::ImageHandle image : data.in)
                    builder.read(image, Access::SampledCompute);
                data.kept = {
                    builder.write(target.color, Access::StorageWrite),
                    builder.write(target.surface, Access::StorageWrite)};
            },
            [this, params](const Data& data, graph::PassContext& context) {
                const graph::PassResources& resources = context.resources;
                gpu::BindingList bindings;
                bindings.sampled(resources.view(data.in[0]), mSampler)
                    .sampled(resources.view(data.in[1]), mSampler)
                    .storage(resources.image(data.kept.surface))
                    .sampled(resources.view(data.in[2]), mSampler)
                    .storage(resources.image(data.kept.color));
                dispatchPixels(context, mPackKept.get(), bindings, params, params.sizePx);
            }
        )
        .kept;
}

graph::ImageHandle SurfaceLayers::addPack(
    graph::Graph& graph,
    const gpu::LazyPipeline& pack,
    graph::ImageHandle motionDepth,
    graph::ImageHandle entityId,
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
                builder.read(motionDepth, Access::SampledCompute);
                builder.read(entityId, Access::SampledCompute);
                data.surface = builder.write(target, Access::StorageWrite);
            },
            [this, &pack, motionDepth, entityId, params](
                const Data& data, graph::PassContext& context
            ) {
                const graph::PassResources& resources = context.resources;
                gpu::BindingList bindings;
                bindings.sampled(resources.view(motionDepth), mSampler)
                    .sampled(resources.view(entityId), mSampler)
                    .storage(resources.image(data.surface));
                dispatchPixels(context, pack.get(), bindings, params, params.sizePx);
            }
        )
        .surface;
}

} // namespace shutter::motion_blur
