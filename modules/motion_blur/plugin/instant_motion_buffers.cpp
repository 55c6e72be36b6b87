// SPDX-License-Identifier: MIT
#include "modules/motion_blur/plugin/instant_motion_buffers.h"

#include <utility>

namespace shutter::motion_blur {

InstantMotions InstantMotionBuffers::update(
    const render::PostContext& context, uint32_t instantCount, bool keepsRaster
) {
    if (!keepsRaster)
        forget();
    const render::SecondRasterView* const second = context.secondRaster;
    std::optional<extract::InstantFrame> secondFrame;
    if (second)
        secondFrame.emplace(second->instant, *second->frame, context.view.jitterPx);
    extract::ViewRequest view = context.view;
    view.jitterPx = context.colorJitterPx;
    extract::InstantTables tables = extract::computeInstantTables(
        context.world,
        view,
        context.frame,
        instantCount,
        mLast ? &*mLast : nullptr,
        secondFrame ? &*secondFrame : nullptr
    );
    InstantMotions motions;
    motions.table = writeInstantLayers(mDevice, tables, mBuffers.at(context.slot));
    motions.instantCount = instantCount;
    motions.hasLast = tables.last.has_value();
    if (second)
        motions.second = SecondRaster{
            second->gbuffer.color, second->gbuffer.motionDepth, second->gbuffer.entityId};
    if (keepsRaster) {
        motions.history = &mHistory;
        mLast = std::move(tables.record);
    }
    return motions;
}

void InstantMotionBuffers::forget() {
    mLast.reset();
    mHistory.forget();
}

} // namespace shutter::motion_blur
