// SPDX-License-Identifier: MIT
// A filter of one pass: some pictures in, the blurred one out. The methods without a second layer
// differ in their shader and in what it reads.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "shaders/motion_blur/motion_blur_shared.h"

#include <cstdint>
#include <span>
#include <string>

namespace shutter::motion_blur {

class ScreenFilter {
  public:
    /// \param inputCount images that the shader samples at bindings 0, 1, ...; it stores to the
    /// next
    ScreenFilter(
        gpu::Device& device, std::string name, std::span<const uint32_t> spirv, uint32_t inputCount
    );

    /// \param inputs as many as the shader samples (CHECKed); the first is the colour, whose size
    /// and format the result has
    /// \param suffix told apart in the graph's names where the filter runs more than once
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph,
        std::span<const graph::ImageHandle> inputs,
        const shader::MotionBlurParams& params,
        const std::string& suffix = "") const;

  private:
    std::string mName;
    uint32_t mInputCount;
    VkSampler mSampler;
    gpu::Pipeline mPipeline;
};

} // namespace shutter::motion_blur
