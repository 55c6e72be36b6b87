// SPDX-License-Identifier: MIT
// When each transient lives, and where images go in the one block of memory they share.
#pragma once

#include "engine/graph/compile.h"

namespace shutter::graph {

/// Fills Plan::images, Plan::buffers and the sums from the ordered passes: first and last use, and
/// usage flags. Outputs live to the end of the frame.
void placeTransients(const Graph& graph, const RequirementFunction& requirement, Plan& plan);

/// Gives each an offset so that no two that live at the same time overlap: largest first, each as
/// low as it fits. Returns the size of the block.
VkDeviceSize packImages(std::vector<Placement>& images);

[[nodiscard]] bool overlapInTime(const Placement& a, const Placement& b);
[[nodiscard]] bool overlapInMemory(const Placement& a, const Placement& b);

} // namespace shutter::graph
