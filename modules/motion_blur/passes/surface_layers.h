// SPDX-License-Identifier: MIT
// Raster images as layers for lookups: this frame's, and the previous one's.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/params.h"

namespace shutter::motion_blur {

struct SurfaceLayer {
    graph::ImageHandle color;   ///< RGBA16F, sharp
    graph::ImageHandle surface; ///< RG32UI: depth; key, inner corners (resolved.glsl)
};

struct SurfaceLayersOutputs {
    SurfaceLayer raster; ///< the stored copy, if there is one: the picture may then be overwritten
    SurfaceLayer second; ///< of the exposure's other end; invalid handles: there is none
    SurfaceLayer last;   ///< invalid handles: there is none, or none was wanted
};

class SurfaceLayers {
  public:
    explicit SurfaceLayers(gpu::Device& device);

    /// Keeps this frame's raster in the frame's history, if it has one.
    /// \param wantLast the raster that the history holds is a layer, too
    [[nodiscard]] SurfaceLayersOutputs
    add(graph::Graph& graph, const MotionBlurInputs& inputs, const PassParams& params, bool wantLast
    ) const;

  private:
    /// A pass for rasters with one sample per pixel and with several.
    struct Pack {
        gpu::LazyPipeline single;
        gpu::LazyPipeline edges;
    };

    /// Inputs of packing a raster.
    struct PackInputs {
        graph::ImageHandle motionDepth;
        graph::ImageHandle entityId;
        bool hasEdges = false;    ///< motionDepth has bits of samples (MotionBlurInputs)
        graph::ImageHandle color; ///< copied as well, by mPackKept; invalid: it is not
    };

    /// \param target its colour is written if the raster's is copied
    /// \return target, as written
    [[nodiscard]] SurfaceLayer addPack(
        graph::Graph& graph,
        const Pack& pack,
        const PackInputs& raster,
        const SurfaceLayer& target,
        const PassParams& params
    ) const;

    /// The colour, on software devices: 0.3 ms at 640x360 on lavapipe, where shaders take 2.4 ms
    /// for it if most of a picture is static.
    bool mKeepsByTransfer;
    VkSampler mSampler;
    Pack mPack;
    Pack mPackKept;      ///< keeps the colour, too
    Pack mPackKeptWhole; ///< the same without motion vectors
    Pack mPackWhole;     ///< of rasters whose motion vectors are not used
};

} // namespace shutter::motion_blur
