// SPDX-License-Identifier: MIT
// Passes over pictures that were made in main memory.
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/graph/graph.h"
#include "engine/graph/transient_pool.h"
#include "engine/image/image.h"
#include "engine/render/readback.h"
#include "modules/motion_blur/motion_blur.h"
#include "tests/conformance/stability/measured.h"

#include <cstdint>
#include <deque>

namespace shutter::stability {

/// One frame: pictures go in, passes are declared on `graph`, pictures come back.
class GBufferRig {
  public:
    explicit GBufferRig(gpu::Device& device);

    graph::Graph graph;

    /// Four channels, as RGBA32F.
    [[nodiscard]] graph::ImageHandle upload(const image::Image& picture);
    /// Four channels, as RGBA16F: the format of colours, which images made like this one inherit.
    /// Values are rounded to half floats.
    [[nodiscard]] graph::ImageHandle uploadColor(const image::Image& picture);
    /// One channel of whole numbers, as R32_UINT.
    [[nodiscard]] graph::ImageHandle uploadIds(const image::Image& ids);
    /// Asks for a picture; \return the ticket for take()
    [[nodiscard]] size_t want(graph::ImageHandle image);
    /// Records, submits and waits. Error: the graph does not compile.
    [[nodiscard]] core::Status run();

    [[nodiscard]] image::Image take(size_t ticket) const { return mReadback.take(ticket); }

  private:
    graph::ImageHandle
    upload(const image::Image& picture, VkFormat format, std::span<const std::byte> texels);

    gpu::Device& mDevice;
    gpu::Frame mFrame;
    graph::TransientPool mPool;
    render::Readback mReadback;
    std::deque<gpu::Image> mUploads; ///< the graph keeps pointers to them
};

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
