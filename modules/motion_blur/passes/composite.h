// SPDX-License-Identifier: MIT
// Puts blended surfaces over the blurred picture, part by part of the exposure.
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "shaders/common/instant_surfaces.glsl"

#include <cstdint>
#include <functional>

namespace shutter::motion_blur {

/// Blended surfaces of one part of the exposure, in a rectangle of the picture.
struct BlendedSums {
    graph::ImageHandle color; ///< RGBA16F: premultiplied, each instant by its share of the exposure
    /// RGBA16F: opacity in red, likewise; invalid: it is in alpha of `color`.
    graph::ImageHandle opacity;
    float share = 1.0f; ///< of the exposure that the part is
};

/// Declares what draws a part.
using DrawBlendedPart = std::function<BlendedSums(uint32_t part)>;

class Composite {
  public:
    explicit Composite(gpu::Device& device);

    /// \param picture RGBA16F, with storage usage; the background
    /// \param draw called for each part in turn, before the pass that composites it: images of
    /// different parts may share memory
    /// \param rectangle whose parts they are, and whose instants and parts describe `surfaces`
    /// \param surfaces of InstantSurfacesPass; invalid: the picture lies behind each part
    /// \return the picture with all parts over it
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph,
        graph::ImageHandle picture,
        const DrawBlendedPart& draw,
        const shader::InstantSurfaces& rectangle,
        graph::BufferHandle surfaces);

  private:
    gpu::Device& mDevice;
    gpu::LazyPipeline mWhole;
    gpu::LazyPipeline mParts;
    gpu::Buffer mNoSurfaces; ///< bound where none are read
};

} // namespace shutter::motion_blur
