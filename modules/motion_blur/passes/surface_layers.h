// SPDX-License-Identifier: MIT
// Raster images as layers that pixels are looked up in: this frame's, and the last one's, which is
// kept from frame to frame.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/params.h"

#include <array>
#include <cstdint>

namespace shutter::motion_blur {

struct SurfaceLayer {
    graph::ImageHandle color;   ///< RGBA16F, sharp
    graph::ImageHandle surface; ///< RG32F: depth, key (resolved_shared.h)
};

struct SurfaceLayersOutputs {
    SurfaceLayer raster;
    SurfaceLayer last; ///< invalid handles: there is none, or none was wanted
};

class SurfaceLayers {
  public:
    explicit SurfaceLayers(gpu::Device& device);

    /// \param wantLast the raster given in the call before is a layer, too
    /// \param keep this frame's raster is kept for the next call
    SurfaceLayersOutputs
    add(graph::Graph& graph,
        const MotionBlurInputs& inputs,
        const PassParams& params,
        bool wantLast,
        bool keep);

    /// Whether a raster of that size is kept.
    [[nodiscard]] bool holds(glm::uvec2 sizePx) const;

    /// Memory of what is kept, bytes.
    [[nodiscard]] uint64_t keptBytes() const;

  private:
    struct Kept {
        gpu::Image color;
        gpu::Image surface;
        bool hasContents = false;
    };

    static SurfaceLayer importKept(graph::Graph& graph, const Kept& kept, VkImageLayout layout);
    void resize(Kept& kept, glm::uvec2 sizePx);
    [[nodiscard]] graph::ImageHandle addPack(
        graph::Graph& graph,
        const MotionBlurInputs& inputs,
        graph::ImageHandle target,
        const PassParams& params
    ) const;

    gpu::Device& mDevice;
    VkSampler mSampler;
    gpu::LazyPipeline mPack;
    std::array<Kept, 2> mKept; ///< in turns: one is read while the other is written
    uint32_t mNewest = 0;      ///< of mKept
};

} // namespace shutter::motion_blur
