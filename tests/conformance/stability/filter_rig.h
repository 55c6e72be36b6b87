// SPDX-License-Identifier: MIT
// G-buffers made in memory, and the motion blur's filters over them.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/image/image.h"
#include "modules/motion_blur/motion_blur.h"

#include <cstdint>
#include <vector>

namespace shutter::stability {

/// A synthetic G-buffer; all of one size.
struct GBuffer {
    image::Image color;       ///< RGBA
    image::Image motionDepth; ///< motion in pixels, depth in metres, unused

    GBuffer(uint32_t width, uint32_t height)
        : color(width, height, 4), motionDepth(width, height, 4) {}

    /// Rounds to half floats, as the image that is filtered holds them.
    void setColor(uint32_t x, uint32_t y, float r, float g, float b);
    void setMotion(uint32_t x, uint32_t y, float right, float down, float depth);
};

/// What a filter of one layer made of it.
struct Blurred {
    image::Image color;
    image::Image tiles;    ///< empty where the method has none
    image::Image dominant; ///< likewise
};

/// The motion blur's methods that need no rays.
[[nodiscard]] std::vector<const motion_blur::Method*> listFilters();

/// Filters G-buffers with one set of pipelines.
class FilterRig {
  public:
    explicit FilterRig(gpu::Device& device) : mDevice(device), mEffect(device, VK_NULL_HANDLE) {}

    [[nodiscard]] core::Result<Blurred> blur(
        const GBuffer& gbuffer,
        const motion_blur::MotionBlurSettings& settings,
        double rasterTime = 0.5
    );

  private:
    gpu::Device& mDevice;
    motion_blur::MotionBlur mEffect;
};

} // namespace shutter::stability
