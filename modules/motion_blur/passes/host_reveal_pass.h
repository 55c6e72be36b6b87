// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/host_answers.h"
#include "modules/motion_blur/passes/ray_reveal.h"

namespace shutter::motion_blur {

/// Adds the pass in which a host's commands render the background of masked pixels.
/// \param inputs of which the scene and the slot are ignored
/// \param own must outlive the graph
[[nodiscard]] RayRevealOutputs addHostReveal(
    graph::Graph& graph,
    const gpu::Device& device,
    const RayRevealInputs& inputs,
    const HostReveal& own
);

} // namespace shutter::motion_blur
