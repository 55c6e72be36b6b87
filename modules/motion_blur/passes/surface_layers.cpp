// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/surface_layers.h"

#include "spirv/motion_blur/resolved_surface.comp.h"
#include "spirv/motion_blur/resolved_surface_kept.comp.h"

#include "modules/motion_blur/instant_motions.h"
#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

constexpr VkFormat kSurfaceFormat = VK_FORMAT_R32G32_UINT;
constexpr VkImageLayout kKeptLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

gpu::ComputePipelineDesc describePack(bool skipsStill, bool hasEdges) {
    gpu::ComputePipelineDesc desc = describePass(
        "pack surface", motion_blur_resolved_surface_comp, {kSampled, kSampled, kStorage}
    );
    desc.specialization = {skipsStill ? 1u : 0u, hasEdges ? 1u : 0u};
    return desc;
}

gpu::ComputePipelineDesc describePackKept(bool skipsStill, bool hasEdges) {
    gpu::ComputePipelineDesc desc = describePack(skipsStill, hasEdges);
    desc.spirv = motion_blur_resolved_surface_kept_comp;
    desc.interface.bindings.insert(desc.interface.bindings.end(), {kSampled, kStorage});
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
      mPack{{device, describePack(true, false)}, {device, describePack(true, true)}},
      mPackKept{{device, describePackKept(true, false)}, {device, describePackKept(true, true)}},
      mPackKeptWhole{
          {device, describePackKept(false, false)}, {device, describePackKept(false, true)}},
      mPackWhole{{device, describePack(false, false)}, {device, describePack(false, true)}} {}

SurfaceLayersOutputs SurfaceLayers::add(
    graph::Graph& graph, const MotionBlurInputs& inputs, const PassParams& params, bool wantLast
) const {
    RasterHistory* const history = inputs.instantMotions->history;
    SurfaceLayersOutputs outputs;
    const auto& lent = inputs.instantMotions->lent;
    // Static surfaces may be out of focus.
    const bool hasLens = inputs.instantMotions->hasLens;
    const Pack& packPlain = hasLens ? mPackWhole : mPack;
    const auto pack = [&](graph::ImageHandle color,
                          const Pack& pipeline,
                          graph::ImageHandle motionDepth,
                          graph::ImageHandle entityId,
                          bool hasEdges) {
        const SurfaceLayer target{{}, createSurface(graph, params)};
        const PackInputs raster{motionDepth, entityId, hasEdges, {}};
        return SurfaceLayer{color, addPack(graph, pipeline, raster, target, params).surface};
    };
    if (wantLast && lent)
        outputs.last =
            pack(lent->color, packPlain, lent->motionDepth, lent->entityId, lent->hasEdges);
    else if (wantLast)
        outputs.last = importRaster(graph, history->newest(), kKeptLayout);
    if (history && inputs.instantMotions->keepsRaster) {
        const SurfaceLayer target =
            importRaster(graph, history->turn(params.sizePx), VK_IMAGE_LAYOUT_UNDEFINED);
        if (mKeepsByTransfer) {
            const auto kept = addKeepColor(graph, inputs.color, target.color);
            const PackInputs raster{
                inputs.motionDepth, inputs.entityId, inputs.edgeSurface.isValid(), {}};
            outputs.raster = {kept, addPack(graph, packPlain, raster, target, params).surface};
        } else {
            const PackInputs raster{
                inputs.motionDepth, inputs.entityId, inputs.edgeSurface.isValid(), inputs.color};
            outputs.raster =
                addPack(graph, hasLens ? mPackKeptWhole : mPackKept, raster, target, params);
        }
        graph.markOutput(outputs.raster.color);
        graph.markOutput(outputs.raster.surface);
    } else {
        outputs.raster = pack(
            inputs.color,
            packPlain,
            inputs.motionDepth,
            inputs.entityId,
            inputs.edgeSurface.isValid()
        );
    }
    if (const auto& second = inputs.instantMotions->second)
        outputs.second = pack(
            second->color, mPackWhole, second->motionDepth, second->entityId, second->hasEdges
        );
    return outputs;
}

SurfaceLayer SurfaceLayers::addPack(
    graph::Graph& graph,
    const Pack& pack,
    const PackInputs& raster,
    const SurfaceLayer& target,
    const PassParams& params
) const {
    struct Data {
        PackInputs raster;
        SurfaceLayer packed;
    };

    return graph
        .addPass<Data>(
            "pack surface",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                data.raster = raster;
                builder.read(raster.motionDepth, Access::SampledCompute);
                builder.read(raster.entityId, Access::SampledCompute);
                data.packed.surface = builder.write(target.surface, Access::StorageWrite);
                if (!raster.color.isValid())
                    return;
                builder.read(raster.color, Access::SampledCompute);
                data.packed.color = builder.write(target.color, Access::StorageWrite);
            },
            [this, &pack, params](const Data& data, graph::PassContext& context) {
                const graph::PassResources& resources = context.resources;
                gpu::BindingList bindings;
                bindings.sampled(resources.view(data.raster.motionDepth), mSampler)
                    .sampled(resources.view(data.raster.entityId), mSampler)
                    .storage(resources.image(data.packed.surface));
                if (data.raster.color.isValid())
                    bindings.sampled(resources.view(data.raster.color), mSampler)
                        .storage(resources.image(data.packed.color));
                const gpu::Pipeline& pipeline =
                    (data.raster.hasEdges ? pack.edges : pack.single).get();
                dispatchPixels(context, pipeline, bindings, params, params.sizePx);
            }
        )
        .packed;
}

} // namespace shutter::motion_blur
