// SPDX-License-Identifier: MIT
// The near field of a picture, and what rays see past it where it covers a pixel in part.
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "engine/graph/ray_scene.h"
#include "engine/render/frame_statistics.h"
#include "shaders/depth_of_field/depth_of_field_shared.h"

#include <array>
#include <cstdint>

namespace shutter::depth_of_field {

struct LensRaysInputs {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle reach; ///< of `lens reach`
    graph::RayScene rays;
    uint32_t slot = 0; ///< render::PictureContext::slot
};

struct LensRaysOutputs {
    graph::ImageHandle near;   ///< RGBA16F: colour, and the share of the pixel that it covers
    graph::ImageHandle behind; ///< RGBA16F: colour, and the radius of its circle of confusion in
                               ///< pixels; -1: no ray saw it, and the colour is the filter's
};

/// Needs ray queries.
class LensRays {
  public:
    /// \param sceneLayout of the scene's textures
    LensRays(gpu::Device& device, VkDescriptorSetLayout sceneLayout);

    [[nodiscard]] LensRaysOutputs
    add(graph::Graph& graph, const LensRaysInputs& inputs, const shader::LensFilterParams& params);

    /// Adds "pixels masked" and "rays traced" of the slot's last frame, once the GPU has finished
    /// it.
    void count(uint32_t slot, render::Counters& counters) const;

  private:
    [[nodiscard]] graph::BufferHandle addClear(graph::Graph& graph, uint32_t slot) const;

    gpu::Device& mDevice;
    std::array<gpu::LazyPipeline, 2> mPipelines; ///< the second: with blended surfaces
    /// shader::LensRayCounts of each slot.
    std::array<gpu::Buffer, gpu::kMaxFramesInFlight> mCounts;
};

} // namespace shutter::depth_of_field
