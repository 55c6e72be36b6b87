// SPDX-License-Identifier: MIT
#include "engine/graph/compile.h"

#include "engine/graph/compile_stages.h"

#include <utility>

namespace shutter::graph {

core::Result<Plan> compile(const Graph& graph, const RequirementFunction& requirement) {
    if (core::Status status = checkDeclaration(graph); !status)
        return status.error();
    const VersionTable versions(graph);
    Culling culling = cull(graph, versions);
    if (core::Status status = checkResults(graph, versions, culling.kept); !status)
        return status.error();
    const auto order = orderPasses(graph, versions, culling.kept);
    if (!order)
        return order.error();

    Plan plan;
    plan.culled = std::move(culling.culled);
    for (uint32_t pass : order.value())
        plan.passes.push_back({pass, {}, {}});
    placeTransients(graph, requirement, plan);
    placeBarriers(graph, plan);
    return plan;
}

} // namespace shutter::graph
