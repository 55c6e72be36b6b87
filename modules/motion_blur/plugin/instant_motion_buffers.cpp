// SPDX-License-Identifier: MIT
#include "modules/motion_blur/plugin/instant_motion_buffers.h"

#include <utility>

namespace shutter::motion_blur {

InstantMotions InstantMotionBuffers::update(
    const scene::World& world,
    const extract::ViewRequest& view,
    const extract::ExtractedFrame& frame,
    uint32_t instantCount,
    bool keepsRaster,
    uint32_t slot
) {
    if (!keepsRaster)
        forget();
    extract::InstantTables tables =
        extract::computeInstantTables(world, view, frame, instantCount, mLast ? &*mLast : nullptr);
    const VkDeviceAddress address = writeInstantLayers(mDevice, tables, mBuffers.at(slot));
    if (keepsRaster)
        mLast = std::move(tables.record);
    return {address, instantCount, tables.last.has_value(), keepsRaster ? &mHistory : nullptr};
}

void InstantMotionBuffers::forget() {
    mLast.reset();
    mHistory.forget();
}

} // namespace shutter::motion_blur
