// SPDX-License-Identifier: MIT
// extract::InstantTables on the device, and what they need of the frame before.
#pragma once

#include "engine/extract/instant_tables.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/render/post_effect.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/instant_motions.h"

#include <array>
#include <cstdint>
#include <optional>

namespace shutter::motion_blur {

class InstantMotionBuffers {
  public:
    explicit InstantMotionBuffers(gpu::Device& device) : mDevice(device), mHistory(device) {}

    /// \param context the slot's last frame must be finished
    /// \param keepsRaster the next frame may look things up in this one's raster
    [[nodiscard]] InstantMotions
    update(const render::PostContext& context, uint32_t instantCount, bool keepsRaster);

    /// The next frame has none before it.
    void forget();

  private:
    gpu::Device& mDevice;
    std::optional<extract::RasterRecord> mLast; ///< of what mHistory keeps
    RasterHistory mHistory;
    std::array<gpu::Buffer, gpu::kMaxFramesInFlight> mBuffers;
};

} // namespace shutter::motion_blur
