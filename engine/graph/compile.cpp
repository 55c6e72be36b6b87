// SPDX-License-Identifier: MIT
#include "engine/graph/compile.h"

#include "engine/graph/compile_stages.h"

#include <algorithm>
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

bool isWantedAfter(const Graph& graph, const Plan& plan, uint32_t resource, uint32_t position) {
    const auto& outputs = graph.outputs();
    if (std::any_of(outputs.begin(), outputs.end(), [&](const auto& output) {
            return output.first == resource;
        }))
        return true;
    const auto placed =
        std::find_if(plan.images.begin(), plan.images.end(), [&](const auto& image) {
            return image.resource == resource;
        });
    return placed == plan.images.end() || placed->lastPass > position; // imported ones stay
}

} // namespace shutter::graph
