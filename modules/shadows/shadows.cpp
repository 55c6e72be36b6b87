// SPDX-License-Identifier: MIT
#include "modules/shadows/shadows.h"

#include "engine/gpu/frame.h"
#include "modules/shadows/shadow_plan.h"

#include <functional>
#include <string>
#include <utility>

namespace shutter::shadows {

Shadows::Shadows(gpu::Device& device, const gpu_scene::GpuScene& scene)
    : mDevice(device),
      mScene(scene), mMaps{
                         render::PerSlot<ShadowMaps>(device, gpu::kMaxFramesInFlight),
                         render::PerSlot<ShadowMaps>(device, gpu::kMaxFramesInFlight),
                         render::PerSlot<ShadowMaps>(device, gpu::kMaxFramesInFlight)} {}

core::Result<render::Shading> Shadows::extract(const render::RasterExtract& raster) {
    ShadowPlan plan = planShadows(raster, mSettings);
    render::Shading shading;
    shading.run = plan.shadows;
    shading.explanations = {
        {render::ExplainedKind::Work, "shadows", plan.shadows},
        {render::ExplainedKind::Work, "blurred shadows", plan.blur}};
    if (!plan.shadows.run)
        return shading;
    shading.passReason = "what shadow maps show has changed";
    // Static surfaces look different with other settings, too.
    shading.revision = plan.casterRevision +
                       std::hash<std::string>()(core::describeValues(listShadowRows(), mSettings));
    ShadowMaps& maps = mapsOf(raster.kind, raster.slot);
    SHUTTER_TRY(maps.prepare(std::move(plan)));
    shading.slots[shader::kSlotOcclusion] = maps.constants();
    shading.slots[shader::kSlotChanging] = maps.tiles();
    return shading;
}

graph::BufferHandle Shadows::declare(const render::RasterContext& context) {
    if (!mPipelines)
        mPipelines.emplace(mDevice, mScene);
    return mapsOf(context.kind, context.slot)
        .declare(
            context.graph,
            *mPipelines,
            context.frame,
            mScene,
            context.shapes,
            context.frameConstants
        );
}

void Shadows::endFrame() {
    for (render::PerSlot<ShadowMaps>& maps : mMaps)
        maps.endFrame();
}

} // namespace shutter::shadows
