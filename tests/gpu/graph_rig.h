// SPDX-License-Identifier: MIT
// A frame for tests: pictures go in, passes are declared, pictures come back.
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/graph/compile.h"
#include "engine/graph/graph.h"
#include "engine/graph/transient_pool.h"
#include "engine/image/image.h"
#include "engine/render/post_effect.h"
#include "engine/render/readback.h"

#include <cstddef>
#include <deque>
#include <span>
#include <string>

namespace shutter::test {

class GraphRig {
  public:
    explicit GraphRig(gpu::Device& device);

    graph::Graph graph;

    /// Four channels, as RGBA32F, ready to be sampled.
    [[nodiscard]] graph::ImageHandle upload(const image::Image& picture);
    /// Four channels, as RGBA16F, ready to be sampled: the format of colours, which images made
    /// like this one inherit. Values are rounded to half floats.
    [[nodiscard]] graph::ImageHandle uploadColor(const image::Image& picture);
    /// Asks for a picture; \return the ticket for take()
    [[nodiscard]] size_t want(graph::ImageHandle image);
    /// Records, submits and waits. Fails the test where the graph does not compile.
    graph::Plan run();

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

/// What a post effect is given, around one picture.
struct EffectRig {
    EffectRig(GraphRig& rig, graph::ImageHandle color, uint32_t width, uint32_t height);

    render::ViewFacts facts;
    render::GBuffer gbuffer;
    render::Intermediates intermediates{{}};
    render::Explainer explainer;
    render::PostContext context;
};

/// The shader that adds pictures: with index 0, rgb = source's rgb times the scale. Something to
/// dispatch, pushed AccumulateParams.
[[nodiscard]] gpu::Pipeline makeScalePipeline(gpu::Device& device);

} // namespace shutter::test
