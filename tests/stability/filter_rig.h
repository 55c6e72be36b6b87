// SPDX-License-Identifier: MIT
// G-buffers made in memory, and the motion blur's filters over them.
#pragma once

#include "modules/motion_blur/motion_blur.h"
#include "tests/kit/graph_rig.h"
#include "tests/stability/hard_case.h"

#include <optional>

namespace shutter::stability {

/// A synthetic G-buffer; all of one size.
struct GBuffer {
    image::Image color;       ///< RGBA
    image::Image motionDepth; ///< motion in pixels, depth in metres, unused

    GBuffer(uint32_t width, uint32_t height)
        : color(width, height, 4), motionDepth(width, height, 4) {}

    /// Rounds to half floats, as the image that is filtered holds them.
    void setColor(uint32_t x, uint32_t y, float r, float g, float b) {
        const float values[] = {r, g, b};
        for (uint32_t c = 0; c < 3; ++c)
            color.at(x, y, c) = image::roundToHalf(values[c]);
        color.at(x, y, 3) = 1.0f;
    }

    void setMotion(uint32_t x, uint32_t y, float right, float down, float depth) {
        const float values[] = {right, down, depth};
        std::copy(values, values + 3, &motionDepth.at(x, y, 0));
    }
};

/// What a filter of one layer made of it.
struct Blurred {
    image::Image color;
    image::Image tiles;    ///< empty where the method has none
    image::Image dominant; ///< likewise
};

/// Filters G-buffers with one set of pipelines.
class FilterRig {
  public:
    explicit FilterRig(gpu::Device& device) : mDevice(device), mEffect(device, VK_NULL_HANDLE) {}

    Blurred blur(
        const GBuffer& gbuffer,
        const motion_blur::MotionBlurSettings& settings,
        double rasterTime = 0.5
    ) {
        test::GraphRig rig(mDevice);
        motion_blur::MotionBlurInputs inputs;
        inputs.color = rig.uploadColor(gbuffer.color);
        inputs.motionDepth = rig.upload(gbuffer.motionDepth);
        inputs.rasterTime = rasterTime;
        const motion_blur::MotionBlurOutputs outputs = mEffect.add(rig.graph, inputs, settings);
        const bool hasTiles = outputs.view("tile_max").isValid();
        const size_t color = rig.want(outputs.color);
        const size_t tiles = hasTiles ? rig.want(outputs.view("tile_max")) : 0;
        const size_t dominant = hasTiles ? rig.want(outputs.view("tiles")) : 0;
        (void)need(rig.run());
        if (!hasTiles)
            return {rig.take(color), {}, {}};
        return {rig.take(color), rig.take(tiles), rig.take(dominant)};
    }

  private:
    gpu::Device& mDevice;
    motion_blur::MotionBlur mEffect;
};

} // namespace shutter::stability
