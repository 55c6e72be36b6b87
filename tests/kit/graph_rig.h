// SPDX-License-Identifier: MIT
// One frame on a device: pictures go in, passes are declared, pictures come back.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/graph/compile.h"
#include "engine/graph/graph.h"
#include "engine/graph/transient_pool.h"
#include "engine/image/image.h"
#include "engine/render/readback.h"

#include <cstddef>
#include <deque>
#include <span>

namespace shutter::test {

/// Uploaded pictures must have the number of channels in the function's name (CHECKed).
class GraphRig {
  public:
    explicit GraphRig(gpu::Device& device);

    graph::Graph graph;

    /// Four channels, as RGBA32F, ready to be sampled.
    [[nodiscard]] graph::ImageHandle upload(const image::Image& picture);
    /// Four channels, as RGBA16F, ready to be sampled: the format of colours, which images made
    /// like this one inherit. Values are rounded to half floats.
    [[nodiscard]] graph::ImageHandle uploadColor(const image::Image& picture);
    /// One channel of whole numbers, as R32_UINT.
    [[nodiscard]] graph::ImageHandle uploadIds(const image::Image& ids);
    /// Requests a picture; \return the ticket for take()
    [[nodiscard]] size_t want(graph::ImageHandle image);
    /// Records, submits and waits. Error: the graph does not compile.
    [[nodiscard]] core::Result<graph::Plan> run();

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

} // namespace shutter::test
