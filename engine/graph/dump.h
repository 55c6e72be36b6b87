// SPDX-License-Identifier: MIT
#pragma once

#include "engine/graph/compile.h"

#include <string>

namespace shutter::graph {

/// The plan as a person reads it: passes in order with what each reads and writes, barriers with
/// layouts, what was culled and why, images with size, format, life and place in memory.
[[nodiscard]] std::string dump(const Graph& graph, const Plan& plan);

} // namespace shutter::graph
