// SPDX-License-Identifier: MIT
// What the gather needs of the revealed layer besides its pixels: its dominant motion, in tiles
// with masked pixels only; and the layer as whole pictures, for debug views.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/ray_mask.h"
#include "modules/motion_blur/passes/ray_reveal.h"

namespace shutter::motion_blur {

struct RevealedLayerInputs {
    graph::ImageHandle color;       ///< of the raster
    graph::ImageHandle motionDepth; ///< of the raster
    graph::ImageHandle tiles;       ///< longest motion of the raster's tiles
    graph::ImageHandle mask;
    RayRevealOutputs reveal;
};

struct RevealedViews {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
};

class RevealedLayerPasses {
  public:
    explicit RevealedLayerPasses(gpu::Device& device);

    /// RG32F, one texel a tile; written where a tile has masked pixels.
    [[nodiscard]] graph::ImageHandle addDominant(
        graph::Graph& graph,
        const RevealedLayerInputs& inputs,
        const RayMaskOutputs& masked,
        const PassParams& params
    ) const;

    /// Drawn only if they are read.
    [[nodiscard]] RevealedViews addViews(
        graph::Graph& graph, const RevealedLayerInputs& inputs, const PassParams& params
    ) const;

  private:
    VkSampler mSampler;
    gpu::LazyPipeline mTileMax;
    gpu::LazyPipeline mNeighbourMax;
    gpu::LazyPipeline mView;
};

} // namespace shutter::motion_blur
