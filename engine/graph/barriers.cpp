// SPDX-License-Identifier: MIT
#include "engine/graph/compile_stages.h"

#include <algorithm>

namespace shutter::graph {

namespace {

struct Run {
    uint32_t position = 0; ///< of its first pass in the plan
    AccessScope scope;     ///< of all its uses together
    bool writes = false;
    bool isDisjoint = false;   ///< all its passes write, each other texels
    bool needsContents = true; ///< earlier contents are needed
};

struct Half {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
};

/// What happened to a resource so far.
struct State {
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    Half lastWrite;
    Half readers; ///< since the last write, and the stages it was made visible to
};

struct Edge {
    bool needed = false;
    Half src;
    Half dst;
    VkImageLayout oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
};

constexpr Half kEarlierSubmissions{
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT};
constexpr Half kLaterSubmissions{
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
    VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
constexpr Half kHost{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};

std::vector<std::vector<Run>>
collectRuns(const Graph& graph, const Plan& plan, DisjointWrites disjoint) {
    std::vector<std::vector<Run>> runs(graph.resources().size());
    for (uint32_t position = 0; position < plan.passes.size(); ++position) {
        const PassRecord& pass = graph.passes()[plan.passes[position].pass];
        for (const ResourceUse& use : pass.uses) {
            if (use.access == Access::HostRead) // after the frame: a barrier at its end
                continue;
            AccessScope scope = scopeOf(use.access, pass.kind);
            if (!graph.resources()[use.resource].isImage)
                scope.layout = VK_IMAGE_LAYOUT_UNDEFINED;
            const bool writes = use.writeVersion != kNoVersion;
            const bool isDisjoint =
                use.access == Access::StorageWriteDisjoint && disjoint == DisjointWrites::Overlap;
            auto& list = runs[use.resource];
            const bool bothRead = !writes && !list.empty() && !list.back().writes;
            const bool bothAreDisjoint = isDisjoint && !list.empty() && list.back().isDisjoint;
            if ((bothRead || bothAreDisjoint) && list.back().scope.layout == scope.layout) {
                list.back().scope.stages |= scope.stages;
                list.back().scope.reads |= scope.reads;
            } else {
                list.push_back({position, scope, writes, isDisjoint, use.readVersion != kNoVersion}
                );
            }
        }
    }
    return runs;
}

bool contains(uint64_t all, uint64_t part) {
    return (all & part) == part;
}

Edge findEdge(const State& state, const Run& run) {
    Edge edge;
    edge.dst = {run.scope.stages, run.scope.reads | run.scope.writes};
    // Unneeded contents are discarded with the old layout.
    edge.oldLayout = run.needsContents ? state.layout : VK_IMAGE_LAYOUT_UNDEFINED;
    const bool transition = run.scope.layout != state.layout;
    if (state.readers.stages == 0) {
        edge.src = state.lastWrite;
        edge.needed = transition || edge.src.stages != 0;
    } else {
        // Readers already waited for the last write, so waiting for them suffices. The write is
        // available; it has to be made visible to stages that have not read it.
        edge.src = {state.readers.stages, 0};
        edge.needed = true;
        const bool seen = contains(state.readers.stages, run.scope.stages) &&
                          contains(state.readers.access, run.scope.reads);
        if (!transition && (seen || !run.needsContents)) {
            edge.dst.access = 0;
        } else if (!transition) {
            edge.src.stages |= state.lastWrite.stages;
            edge.src.access = state.lastWrite.access;
        }
    }
    if (!transition)
        edge.oldLayout = state.layout;
    return edge;
}

void advance(State& state, const Run& run) {
    if (run.writes) {
        state.lastWrite = {run.scope.stages, run.scope.writes};
        state.readers = {};
    } else {
        state.readers = {run.scope.stages, run.scope.reads};
    }
    state.layout = run.scope.layout;
}

/// The last uses of every image that had a part of this one's memory before.
Half findPreviousTenants(
    const Plan& plan, const std::vector<std::vector<Run>>& runs, const Placement& image
) {
    Half result;
    for (const Placement& other : plan.images) {
        if (other.lastPass >= image.firstPass || !overlapInMemory(image, other))
            continue;
        const Run& last = runs[other.resource].back();
        result.stages |= last.scope.stages;
        result.access |= last.scope.writes;
    }
    return result;
}

State findStart(
    const Graph& graph,
    const Plan& plan,
    const std::vector<std::vector<Run>>& runs,
    uint32_t resource
) {
    const ResourceRecord& record = graph.resources()[resource];
    State state;
    if (record.imported) {
        state.layout = record.initialLayout;
        state.lastWrite = record.before ? Half{record.before->stages, record.before->access}
                                        : kEarlierSubmissions;
    } else if (record.isImage) {
        const auto image =
            std::find_if(plan.images.begin(), plan.images.end(), [&](const Placement& other) {
                return other.resource == resource;
            });
        if (image != plan.images.end())
            state.lastWrite = findPreviousTenants(plan, runs, *image);
    }
    return state;
}

bool hostReads(const Graph& graph, const Plan& plan, uint32_t resource) {
    const auto& outputs = graph.outputs();
    if (std::any_of(outputs.begin(), outputs.end(), [&](const auto& output) {
            return output.first == resource;
        }))
        return true;
    return std::any_of(plan.passes.begin(), plan.passes.end(), [&](const PlannedPass& planned) {
        const auto& uses = graph.passes()[planned.pass].uses;
        return std::any_of(uses.begin(), uses.end(), [&](const ResourceUse& use) {
            return use.resource == resource && use.access == Access::HostRead;
        });
    });
}

void finish(const Graph& graph, Plan& plan, uint32_t resource, const State& state) {
    const ResourceRecord& record = graph.resources()[resource];
    if (!record.imported)
        return;
    if (record.isImage && record.after) {
        const VkImageLayout layout =
            record.finalLayout == VK_IMAGE_LAYOUT_UNDEFINED ? state.layout : record.finalLayout;
        if (layout == VK_IMAGE_LAYOUT_UNDEFINED) // nothing was in it, and nothing is
            return;
        plan.finalImageBarriers.push_back(
            {resource,
             state.readers.stages | state.lastWrite.stages,
             state.lastWrite.access,
             record.after->stages,
             record.after->access,
             state.layout,
             layout}
        );
    } else if (record.isImage) {
        if (record.finalLayout == VK_IMAGE_LAYOUT_UNDEFINED || record.finalLayout == state.layout)
            return;
        const Half src = state.readers.stages ? Half{state.readers.stages, 0} : state.lastWrite;
        plan.finalImageBarriers.push_back(
            {resource,
             src.stages,
             src.access,
             kLaterSubmissions.stages,
             kLaterSubmissions.access,
             state.layout,
             record.finalLayout}
        );
    } else if (hostReads(graph, plan, resource)) {
        plan.finalBufferBarriers.push_back(
            {resource, state.lastWrite.stages, state.lastWrite.access, kHost.stages, kHost.access}
        );
    }
}

} // namespace

void placeBarriers(const Graph& graph, Plan& plan, DisjointWrites disjoint) {
    const std::vector<std::vector<Run>> runs = collectRuns(graph, plan, disjoint);
    for (uint32_t resource = 0; resource < runs.size(); ++resource) {
        State state = findStart(graph, plan, runs, resource);
        for (const Run& run : runs[resource]) {
            const Edge edge = findEdge(state, run);
            PlannedPass& pass = plan.passes[run.position];
            if (edge.needed && graph.resources()[resource].isImage)
                pass.imageBarriers.push_back(
                    {resource,
                     edge.src.stages,
                     edge.src.access,
                     edge.dst.stages,
                     edge.dst.access,
                     edge.oldLayout,
                     run.scope.layout}
                );
            else if (edge.needed)
                pass.bufferBarriers.push_back(
                    {resource, edge.src.stages, edge.src.access, edge.dst.stages, edge.dst.access}
                );
            advance(state, run);
        }
        finish(graph, plan, resource, state);
    }
}

} // namespace shutter::graph
