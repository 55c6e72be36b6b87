// SPDX-License-Identifier: MIT
#include "engine/graph/compile.h"

#include "engine/graph/compile_stages.h"

#include <utility>

namespace shutter::graph {

core::Result<Plan>
compile(const Graph& graph, const RequirementFunction& requirement, DisjointWrites disjoint) {
    SHUTTER_TRY(checkDeclaration(graph));
    const VersionTable versions(graph);
    Culling culling = cull(graph, versions);
    SHUTTER_TRY(checkResults(graph, versions, culling.kept));
    const auto order = orderPasses(graph, versions, culling.kept);
    if (!order)
        return order.error();

    Plan plan;
    plan.culled = std::move(culling.culled);
    for (uint32_t pass : order.value())
        plan.passes.push_back({pass, {}, {}});
    placeTransients(graph, requirement, plan);
    placeBarriers(graph, plan, disjoint);
    return plan;
}

} // namespace shutter::graph
