// SPDX-License-Identifier: MIT
// Simulates a plan pass by pass and tracks all memory: its writers, later readers, waits, and
// visibility. Written from Vulkan's rules (chapter "Synchronization"), not from the graph's code;
// stricter in one way: a barrier is taken to order only the memory it names.
#pragma once

#include "engine/graph/compile.h"

#include <string>
#include <vector>

namespace shutter::graph {

/// A sentence for each hazard, wrong layout, wrong contents and lost result; empty: the plan holds.
[[nodiscard]] std::vector<std::string> findHazards(const Graph& graph, const Plan& plan);

} // namespace shutter::graph
