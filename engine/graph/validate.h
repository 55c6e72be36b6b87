// SPDX-License-Identifier: MIT
// Is the declared frame one that can run? Errors name the pass and the resource.
#pragma once

#include "engine/core/result.h"
#include "engine/graph/order.h"

namespace shutter::graph {

/// What can be said before it is known which passes stay: culled passes are checked too.
[[nodiscard]] core::Status checkDeclaration(const Graph& graph);

/// Outputs and what the host reads must still be there when the frame ends.
[[nodiscard]] core::Status
checkResults(const Graph& graph, const VersionTable& versions, const std::vector<bool>& kept);

} // namespace shutter::graph
