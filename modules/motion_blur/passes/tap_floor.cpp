// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/tap_floor.h"

#include "spirv/motion_blur/tap_floor.comp.h"

#include <array>

namespace shutter::motion_blur {

TapFloor::TapFloor(gpu::Device& device)
    : mFilter(device, shader::kMixedList, {"gather floor", motion_blur_tap_floor_comp, 3}) {}

graph::ImageHandle TapFloor::add(
    graph::Graph& graph,
    const TapFloorInputs& inputs,
    const BlockLists& lists,
    const PassParams& params
) const {
    const auto mean = graph.createImage("gather floor", graph.describeImage(inputs.color));
    return mFilter.add(
        graph, std::array{inputs.color, inputs.motionDepth, inputs.dominant}, lists, mean, params
    );
}

} // namespace shutter::motion_blur
