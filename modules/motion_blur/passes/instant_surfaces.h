// SPDX-License-Identifier: MIT
// Surfaces visible in the pixels of a rectangle at some of the instants, for surfaces drawn over
// the blurred picture.
#pragma once

#include "engine/gpu/device.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/passes/resolve_pass.h"
#include "shaders/common/instant_surfaces.glsl"

#include <span>

namespace shutter::motion_blur {

/// Size of the buffer, bytes.
[[nodiscard]] inline VkDeviceSize surfaceBytes(const shader::InstantSurfaces& head) {
    const VkDeviceSize pixels = VkDeviceSize(head.sizePx.x) * head.sizePx.y;
    return sizeof(head) + pixels * shader::surfaceWordsPerPixel(head) * sizeof(uint32_t);
}

class InstantSurfacesPass {
  public:
    explicit InstantSurfacesPass(gpu::Device& device);

    /// Fills ResolvePassOutputs::surfaces.
    /// \param wanted rectangles that lie in the picture; empty: none are needed
    /// \param found of a ResolvePass; its counters and its picture come back as other versions
    /// \param params that the ResolvePass used
    void
    add(graph::Graph& graph,
        std::span<const shader::InstantSurfaces> wanted,
        ResolvePassOutputs& found,
        const PassParams& params) const;

  private:
    void addOne(
        graph::Graph& graph,
        const shader::InstantSurfaces& wanted,
        ResolvePassOutputs& found,
        const PassParams& params
    ) const;

    gpu::Device& mDevice;
    SearchPipelines mPipelines;
};

} // namespace shutter::motion_blur
