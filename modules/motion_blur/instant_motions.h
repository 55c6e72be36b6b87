// SPDX-License-Identifier: MIT
// What InstantMotions (frame_io.h) refers to, on the device: a frame's tables of motion, and the
// raster of the previous frame.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/math/layer_tables.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace shutter::motion_blur {

struct WrittenLayers {
    VkDeviceAddress table = 0; ///< shader::InstantMotions
    bool mayHide = false;      ///< InstantMotions::mayHide
};

/// Writes all tables into the buffer, which is recreated if it is too small. The GPU must have
/// finished with its contents. Throws gpu::DeviceError if out of memory.
/// \param sizePx of the picture
[[nodiscard]] WrittenLayers writeInstantLayers(
    gpu::Device& device, const math::InstantLayers& layers, glm::uvec2 sizePx, gpu::Buffer& buffer
);

/// Whether there are so many movers that a tile's list may overflow.
[[nodiscard]] bool mayCrowdTiles(const math::InstantLayers& layers);

/// A view's raster, stored for the next frame. The owner of a view's frames holds one; whichever
/// lookup method runs fills and reads it.
class RasterHistory {
  public:
    struct Raster {
        gpu::Image color;   ///< RGBA16F, sharp
        gpu::Image surface; ///< RG32UI: depth; key, inner corners (resolved.glsl)
    };

    explicit RasterHistory(gpu::Device& device) : mDevice(device) {}

    /// Whether a raster of that size is stored.
    [[nodiscard]] bool holds(glm::uvec2 sizePx) const;

    /// The last stored raster; holds() must be true.
    [[nodiscard]] const Raster& newest() const { return mRasters.at(mNewest); }

    /// Discards the newest raster, which must exist; the one before it becomes the newest.
    void stepBack() { mNewest = 1 - mNewest; }

    /// Images for another raster, which becomes the newest; the one before stays as it is until the
    /// next call.
    [[nodiscard]] const Raster& turn(glm::uvec2 sizePx);

    /// Two rasters that have no memory, for graphs that are compiled and never run.
    void fillPlaceholders(glm::uvec2 sizePx);

    /// Discards the history and frees its memory once the GPU has finished with it.
    void forget();

    /// Device memory of the history, bytes: 32 per pixel once it holds two rasters.
    [[nodiscard]] uint64_t bytes() const;

  private:
    gpu::Device& mDevice;
    std::array<Raster, 2> mRasters; ///< in turns: one is read while the other is written
    std::array<bool, 2> mHasContents{};
    uint32_t mNewest = 0; ///< of mRasters
};

} // namespace shutter::motion_blur
