// SPDX-License-Identifier: MIT
// The background behind masked pixels (Tan et al., "Recursive Ray Tracing").
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/ray_pipeline.h"
#include "engine/graph/graph.h"
#include "engine/graph/ray_scene.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/masked_pixels.h"

#include <array>
#include <optional>
#include <vector>

namespace shutter::motion_blur {

struct RayRevealInputs {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle entityId;
    MaskedPixels masked;
    graph::RayScene rays;      ///< no TLAS: nothing but sky is found
    uint32_t slot = 0;         ///< of the frames in flight, below kMaxSlots
    bool wantsCounters = true; ///< count() is called for the frame
};

/// Written at masked pixels only.
struct RayRevealOutputs {
    graph::ImageHandle color;
    graph::ImageHandle motionDepth;
    graph::ImageHandle entityId;
};

/// The images of a frame's reveal, which nothing has written yet.
[[nodiscard]] RayRevealOutputs createRevealed(graph::Graph& graph, const RayRevealInputs& inputs);

/// VkTraceRaysIndirectCommandKHR of one launch a masked pixel.
/// \param list of MaskedPixels
[[nodiscard]] graph::BufferHandle addLaunchSize(graph::Graph& graph, graph::BufferHandle list);

/// By ray queries in a compute shader, or by a ray-tracing pipeline: what the device has.
class RayReveal {
  public:
    RayReveal(gpu::Device& device, VkDescriptorSetLayout sceneLayout);
    RayRevealOutputs
    add(graph::Graph& graph, const RayRevealInputs& inputs, const PassParams& params);

    /// Whether add() waits for no pipeline that traces rays, as they are made ahead of their use
    /// and are ready. True where each is made when it is first used.
    [[nodiscard]] bool isReady() const;

    /// Makes count() include a frame whose masked pixels a host reveals.
    /// \param list of MaskedPixels
    void countOwn(graph::Graph& graph, graph::BufferHandle list, uint32_t slot);

    struct Counts {
        uint32_t maskedPixels = 0;
        uint32_t raysTraced = 0;
    };

    /// What the slot's last frame with RayRevealInputs::wantsCounters counted; valid once the GPU
    /// is done with it.
    [[nodiscard]] Counts count(uint32_t slot) const;

  private:
    /// Made for the first frame that needs it.
    const gpu::Pipeline& findPipeline(const graph::RayScene& rays);
    void addCounters(graph::Graph& graph, graph::BufferHandle list, uint32_t slot) const;
    void launch(
        graph::PassContext& context,
        const RayRevealInputs& inputs,
        const PassParams& params,
        graph::BufferHandle launchSize
    ) const;

    gpu::Device& mDevice;
    VkSampler mSampler;
    gpu::LazyPipeline mSky; ///< for frames without rays
    /// Without and with blended surfaces: both, as the first blended surface may come into sight in
    /// any frame.
    std::vector<gpu::LazyPipeline> mPipelines;
    std::array<std::optional<gpu::RayPipeline>, 2> mTracers; ///< the same where rays need them
    gpu::Buffer mHeaders;                                    ///< by slot
    std::array<bool, kMaxSlots> mTraces{};                   ///< by slot: not by mSky
};

} // namespace shutter::motion_blur
