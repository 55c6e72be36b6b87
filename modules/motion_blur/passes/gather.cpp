// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/gather.h"

#include "spirv/motion_blur/reconstruct.comp.h"
#include "spirv/motion_blur/reconstruct_masked.comp.h"
#include "spirv/motion_blur/reconstruct_uniform.comp.h"

#include <array>

namespace shutter::motion_blur {

namespace {

/// \param own constant 1, which not every gather has
FilterDesc
describe(const char* name, std::span<const uint32_t> spirv, uint32_t inputCount, uint32_t own = 0) {
    return {name, spirv, inputCount, {own}, true};
}

} // namespace

Gather::Gather(gpu::Device& device) : Gather(device, chooseTapVariants(device)) {}

Gather::Gather(gpu::Device& device, TapVariants taps)
    : mUniform(
          device,
          shader::kUniformList,
          describe("gather uniform", motion_blur_reconstruct_uniform_comp, 2),
          taps
      ),
      mOneLayer(
          device, shader::kMixedList, describe("gather", motion_blur_reconstruct_comp, 3, 0), taps
      ),
      mOneLayerOfCandidates(
          device,
          shader::kCandidateList,
          describe("gather without mask", motion_blur_reconstruct_comp, 3, 1),
          taps
      ),
      mTwoLayers(
          device,
          shader::kMaskedList,
          describe("gather and composite", motion_blur_reconstruct_masked_comp, 7),
          taps
      ) {}

graph::ImageHandle Gather::addUniform(
    graph::Graph& graph,
    const GatherInputs& inputs,
    const SortedBlocks& blocks,
    graph::ImageHandle target,
    const PassParams& params
) const {
    if (!(params.uniformMotionPx > 0.0f))
        return target;
    const std::array uniform{inputs.color, inputs.dominant};
    return mUniform.add(graph, uniform, blocks.lists, target, params);
}

graph::ImageHandle Gather::add(
    graph::Graph& graph,
    const GatherInputs& inputs,
    const SortedBlocks& blocks,
    graph::ImageHandle target,
    const PassParams& params
) const {
    target = addUniform(graph, inputs, blocks, target, params);
    const std::array raster{inputs.color, inputs.motionDepth, inputs.dominant};
    target = mOneLayer.add(graph, raster, blocks.lists, target, params);
    if (!inputs.reveal)
        return target;
    target = mOneLayerOfCandidates.add(graph, raster, blocks.candidates, target, params);
    const RevealedLayer& second = *inputs.reveal;
    const std::array both{
        inputs.color,
        inputs.motionDepth,
        inputs.dominant,
        second.color,
        second.motionDepth,
        second.dominant,
        second.mask};
    return mTwoLayers.add(graph, both, blocks.lists, target, params);
}

} // namespace shutter::motion_blur
