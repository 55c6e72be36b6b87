// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/gather.h"

#include "spirv/motion_blur/reconstruct.comp.h"
#include "spirv/motion_blur/reconstruct_masked.comp.h"
#include "spirv/motion_blur/reconstruct_uniform.comp.h"

#include <array>

namespace shutter::motion_blur {

Gather::Gather(gpu::Device& device)
    : mUniform(
          device, "gather uniform", motion_blur_reconstruct_uniform_comp, 2, shader::kUniformList
      ),
      mOneLayer(device, "gather", motion_blur_reconstruct_comp, 3, shader::kMixedList),
      mTwoLayers(
          device,
          "gather and composite",
          motion_blur_reconstruct_masked_comp,
          7,
          shader::kMaskedList
      ) {}

graph::ImageHandle Gather::add(
    graph::Graph& graph,
    const GatherInputs& inputs,
    const BlockLists& lists,
    graph::ImageHandle target,
    const shader::MotionBlurParams& params
) const {
    if (params.uniformMotionPx > 0.0f)
        target =
            mUniform.add(graph, std::array{inputs.color, inputs.dominant}, lists, target, params);
    target = mOneLayer.add(
        graph, std::array{inputs.color, inputs.motionDepth, inputs.dominant}, lists, target, params
    );
    if (!inputs.reveal)
        return target;
    const RevealedLayer& second = *inputs.reveal;
    return mTwoLayers.add(
        graph,
        std::array{
            inputs.color,
            inputs.motionDepth,
            inputs.dominant,
            second.color,
            second.motionDepth,
            second.dominant,
            second.mask},
        lists,
        target,
        params
    );
}

} // namespace shutter::motion_blur
