// SPDX-License-Identifier: MIT
// extract::InstantTables on the device, and what they need of the frame before.
#pragma once

#include "engine/extract/instant_tables.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/render/post_effect.h"
#include "engine/render/shape_ways.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/instant_motions.h"

#include <array>
#include <cstdint>
#include <optional>

namespace shutter::motion_blur {

class InstantMotionBuffers {
  public:
    /// \param scene must outlive this
    InstantMotionBuffers(gpu::Device& device, const gpu_scene::GpuScene& scene)
        : mDevice(device), mScene(scene), mHistory(device) {}

    /// \param context the slot's last frame must be finished
    /// \param keepsRaster the next frame may look things up in this one's raster
    [[nodiscard]] InstantMotions
    update(const render::PostContext& context, uint32_t instantCount, bool keepsRaster);

    /// The next frame has none before it.
    void forget();

  private:
    /// \return empty where nothing deforms
    [[nodiscard]] DrawWays
    declareWays(const render::PostContext& context, const extract::InstantTables& tables);

    gpu::Device& mDevice;
    const gpu_scene::GpuScene& mScene;
    std::optional<extract::RasterRecord> mLast; ///< of what mHistory keeps
    std::array<std::optional<render::ShapeWays>, gpu::kMaxFramesInFlight> mWays; ///< by slot
    RasterHistory mHistory;
    std::array<gpu::Buffer, gpu::kMaxFramesInFlight> mBuffers;
};

} // namespace shutter::motion_blur
