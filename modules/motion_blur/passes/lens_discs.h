// SPDX-License-Identifier: MIT
// Draws bright points out of focus as images of the lens's opening.
#pragma once

#include "modules/motion_blur/passes/resolve_pass.h"

namespace shutter::motion_blur {

class LensDiscs {
  public:
    explicit LensDiscs(gpu::Device& device);

    /// \param found of ResolvePass; without bright points there is no pass
    /// \param picture to which the light is added, filtered by LensFilter
    /// \return picture, as written
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph,
        const ResolvePassOutputs& found,
        graph::ImageHandle picture,
        const PassParams& params) const;

  private:
    gpu::Device& mDevice;
    SearchPipelines mPipelines;
};

} // namespace shutter::motion_blur
