// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/frame.h"
#include "engine/graph/compile.h"
#include "engine/graph/transient_pool.h"

namespace shutter::graph {

/// Real resources behind handles, for execute callbacks.
class PassResources {
  public:
    PassResources(const Graph& graph, const TransientPool& pool) : mGraph(graph), mPool(pool) {}

    [[nodiscard]] const gpu::Image& image(ImageHandle handle) const;

    [[nodiscard]] VkImageView view(ImageHandle handle) const {
        return handle.isStencil ? image(handle).stencilView() : image(handle).view();
    }

    [[nodiscard]] VkBuffer buffer(BufferHandle handle) const;
    /// Transient buffers only.
    [[nodiscard]] VkDeviceAddress address(BufferHandle handle) const;

  private:
    const Graph& mGraph;
    const TransientPool& mPool;
};

/// Compiles, makes the transients and records every pass into `frame`: barriers, a label and a
/// timestamp around each, dynamic rendering begun and ended for raster passes (viewport and scissor
/// set to the whole target). The plan is returned for dump() and statistics.
[[nodiscard]] core::Result<Plan>
execute(const Graph& graph, gpu::Frame& frame, TransientPool& pool);

} // namespace shutter::graph
