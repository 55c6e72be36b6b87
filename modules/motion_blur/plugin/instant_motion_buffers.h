// SPDX-License-Identifier: MIT
// extract::InstantTables on the device, and their data of the previous frame.
#pragma once

#include "engine/extract/instant_tables.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/render/contexts.h"
#include "engine/render/shape_ways.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/instant_motions.h"

#include <array>
#include <cstdint>
#include <optional>

namespace shutter::motion_blur {

class InstantMotionBuffers {
  public:
    struct Instants {
        uint32_t count = 0;    ///< countInstants() (settings.h)
        bool haveLens = false; ///< each has a place of the lens
    };

    /// \param scene must outlive this
    InstantMotionBuffers(gpu::Device& device, const gpu_scene::GpuScene& scene)
        : mDevice(device), mScene(scene), mHistory(device) {}

    /// Whether the raster of the frame before the view's is stored, for a frame that stores its
    /// own. \param taken rows whose blended surfaces are not in the raster
    [[nodiscard]] bool
    holdsFrameBefore(const render::DecideContext& context, std::span<const uint32_t> taken) const;

    /// Computes a frame's tables.
    /// \param hasHistory the raster of the previous frame has lookups, too, which
    /// ExtractContext::lastRaster shows where it is not stored, and the next frame may read
    /// this one's (ViewFacts::isFollowed)
    void extract(const render::ExtractContext& context, const Instants& instants, bool hasHistory);

    /// \param context of the frame that extract() was called for; the slot's last frame must be
    /// finished
    [[nodiscard]] InstantMotions declare(const render::PictureContext& context);

    /// Discards stored rasters and their memory.
    void forget();

  private:
    /// \return empty where nothing deforms
    [[nodiscard]] DrawWays declareWays(const render::PictureContext& context);
    [[nodiscard]] extract::InstantTables
    computeTables(const render::ExtractContext& context, const Instants& instants) const;

    /// Whether the context's frame was the last one and is drawn again: the one before it counts.
    template <class Context>
    [[nodiscard]] bool isAgain(const Context& context, std::span<const uint32_t> taken) const;
    /// Discards the newest raster; the one before it becomes the newest.
    void stepBack();
    gpu::Device& mDevice;
    const gpu_scene::GpuScene& mScene;
    std::optional<extract::RasterRecord> mLast;   ///< of the newest raster of mHistory
    std::optional<extract::RasterRecord> mBefore; ///< of the one stored before
    extract::InstantTables mTables;               ///< of the frame that was extracted
    uint32_t mInstantCount = 0;
    bool mHasHistory = false;
    std::array<std::optional<render::ShapeWays>, gpu::kMaxFramesInFlight> mWays; ///< by slot
    RasterHistory mHistory;
    std::array<gpu::Buffer, gpu::kMaxFramesInFlight> mBuffers;
};

} // namespace shutter::motion_blur
