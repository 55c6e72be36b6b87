// SPDX-License-Identifier: MIT
// A view's anti-aliased picture and the depth of the raster that it was drawn from, kept for the
// frame after, and where this frame's surfaces are in them.
#pragma once

#include "engine/extract/reprojection.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/render/post_effect.h"
#include "shaders/common/instant_motion_shared.h"

#include <array>
#include <cstdint>
#include <optional>

namespace shutter::taa {

class LastPicture {
  public:
    struct Images {
        gpu::Image picture; ///< rgb linear colour, a count of frames
        gpu::Image depth;   ///< metres along the view direction, where the raster's samples lay
    };

    /// A frame's own share of it.
    struct Frame {
        const Images* last = nullptr; ///< null: nothing is known of the frame before
        const Images* kept = nullptr; ///< for this frame's
        shader::LayerMotion places{}; ///< of this frame's surfaces in `last`
        float motionScale = 0.0f;     ///< time since `last` in exposures
        bool isPerspective = true;
    };

    explicit LastPicture(gpu::Device& device) : mDevice(device) {}

    /// Finds where this frame's surfaces are in the last picture. Its view's frames come in their
    /// order.
    void extract(const render::ExtractContext& context);

    /// \param context of the frame that extract() was called for; the slot's last frame must be
    /// finished
    [[nodiscard]] Frame turn(const render::PostContext& context);

    /// The next frame has none before it; the memory goes once the GPU is done with it.
    void forget();

  private:
    [[nodiscard]] shader::LayerMotion
    writePlaces(const math::LayerTables& tables, gpu::Buffer& buffer) const;

    gpu::Device& mDevice;
    std::array<Images, 2> mImages; ///< in turns: one is read while the other is written
    uint32_t mNewest = 0;          ///< of mImages
    std::optional<extract::RasterRecord> mRecord; ///< of the newest
    extract::Reprojection mReprojection;          ///< of the frame that was extracted
    std::array<gpu::Buffer, gpu::kMaxFramesInFlight> mBuffers;
};

} // namespace shutter::taa
