// SPDX-License-Identifier: MIT
// A filter over one list of blocks: some pictures in, the list's pixels of a picture written.
#pragma once

#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "shaders/motion_blur/motion_blur_shared.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace shutter::motion_blur {

class BlockFilter {
  public:
    /// \param inputCount images that the shader samples at bindings 0, 1, ...; it stores to the
    /// next and has the lists at the one after (block_list.glsl)
    /// \param list shader::kUniformList ...
    /// \param constants specialization constants 1, 2, ...
    BlockFilter(
        gpu::Device& device,
        std::string name,
        std::span<const uint32_t> spirv,
        uint32_t inputCount,
        uint32_t list,
        std::vector<uint32_t> constants = {}
    );

    /// \param inputs as many as the shader samples (CHECKed)
    /// \return target with the list's blocks written
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph,
        std::span<const graph::ImageHandle> inputs,
        const BlockLists& lists,
        graph::ImageHandle target,
        const shader::MotionBlurParams& params) const;

  private:
    std::string mName;
    uint32_t mInputCount;
    uint32_t mList;
    VkSampler mSampler;
    gpu::Pipeline mPipeline;
};

} // namespace shutter::motion_blur
