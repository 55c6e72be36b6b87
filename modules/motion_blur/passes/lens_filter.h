// SPDX-License-Identifier: MIT
// What a lens's sets of places leave between neighbouring pixels, averaged out.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"

namespace shutter::motion_blur {

class LensFilter {
  public:
    explicit LensFilter(gpu::Device& device);

    /// \param picture of ResolvePass, whose alpha has the radius of each pixel (resolved_lens.glsl)
    /// \param target another image, or invalid: a new one
    /// \return the target, with an alpha of 1
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph,
        graph::ImageHandle picture,
        graph::ImageHandle target,
        const PassParams& params) const;

  private:
    VkSampler mSampler;
    gpu::LazyPipeline mPipeline;
};

} // namespace shutter::motion_blur
