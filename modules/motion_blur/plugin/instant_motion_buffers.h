// SPDX-License-Identifier: MIT
// extract::InstantTables on the device, and what they need of the frame before.
#pragma once

#include "engine/extract/instant_tables.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/instant_motions.h"

#include <array>
#include <cstdint>
#include <optional>

namespace shutter::motion_blur {

class InstantMotionBuffers {
  public:
    explicit InstantMotionBuffers(gpu::Device& device) : mDevice(device), mHistory(device) {}

    /// \param keepsRaster the next frame may look things up in this one's raster
    /// \param slot of the frames in flight; its last frame must be finished
    [[nodiscard]] InstantMotions update(
        const scene::World& world,
        const extract::ViewRequest& view,
        const extract::ExtractedFrame& frame,
        uint32_t instantCount,
        bool keepsRaster,
        uint32_t slot
    );

    /// The next frame has none before it.
    void forget();

  private:
    gpu::Device& mDevice;
    std::optional<extract::RasterRecord> mLast; ///< of what mHistory keeps
    RasterHistory mHistory;
    std::array<gpu::Buffer, gpu::kMaxFramesInFlight> mBuffers;
};

} // namespace shutter::motion_blur
