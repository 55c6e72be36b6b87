// SPDX-License-Identifier: MIT
#include "engine/graph/compile_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <queue>

namespace shutter::graph {

VersionTable::VersionTable(const Graph& graph) {
    for (const ResourceRecord& resource : graph.resources())
        mVersions.emplace_back(resource.versionCount);
    for (uint32_t pass = 0; pass < graph.passes().size(); ++pass)
        for (const ResourceUse& use : graph.passes()[pass].uses) {
            if (use.readVersion != kNoVersion)
                mVersions[use.resource][use.readVersion].readers.push_back(pass);
            if (use.writeVersion != kNoVersion)
                mVersions[use.resource][use.writeVersion].producer = pass;
        }
}

std::optional<uint32_t> VersionTable::producer(uint32_t resource, uint32_t version) const {
    return mVersions[resource][version].producer;
}

const std::vector<uint32_t>& VersionTable::readers(uint32_t resource, uint32_t version) const {
    return mVersions[resource][version].readers;
}

namespace {

bool isWantedForItself(const Graph& graph, const PassRecord& pass) {
    return pass.hasSideEffect ||
           std::any_of(pass.uses.begin(), pass.uses.end(), [&](const ResourceUse& use) {
               return use.writeVersion != kNoVersion && graph.resources()[use.resource].imported;
           });
}

std::string reasonFor(const Graph& graph, const VersionTable& versions, const PassRecord& pass) {
    std::string names;
    bool hasReader = false;
    for (const ResourceUse& use : pass.uses) {
        if (use.writeVersion == kNoVersion)
            continue;
        names +=
            fmt::format("{}'{}'", names.empty() ? "" : ", ", graph.resources()[use.resource].name);
        hasReader |= !versions.readers(use.resource, use.writeVersion).empty();
    }
    if (names.empty())
        return "writes nothing";
    return (hasReader ? "only culled passes read " : "nobody reads ") + names;
}

} // namespace

Culling cull(const Graph& graph, const VersionTable& versions) {
    const auto& passes = graph.passes();
    Culling result;
    result.kept.assign(passes.size(), false);
    std::vector<uint32_t> open;
    const auto keep = [&](std::optional<uint32_t> pass) {
        if (pass && !result.kept[*pass]) {
            result.kept[*pass] = true;
            open.push_back(*pass);
        }
    };
    for (uint32_t pass = 0; pass < passes.size(); ++pass)
        if (isWantedForItself(graph, passes[pass]))
            keep(pass);
    for (const auto& [resource, version] : graph.outputs())
        keep(versions.producer(resource, version));
    while (!open.empty()) {
        const uint32_t pass = open.back();
        open.pop_back();
        for (const ResourceUse& use : passes[pass].uses)
            if (use.readVersion != kNoVersion)
                keep(versions.producer(use.resource, use.readVersion));
    }
    for (uint32_t pass = 0; pass < passes.size(); ++pass)
        if (!result.kept[pass])
            result.culled.push_back({passes[pass].name, reasonFor(graph, versions, passes[pass])});
    return result;
}

namespace {

/// Passes that each pass has to wait for.
std::vector<std::vector<uint32_t>>
findPredecessors(const Graph& graph, const VersionTable& versions, const std::vector<bool>& kept) {
    std::vector<std::vector<uint32_t>> before(graph.passes().size());
    for (uint32_t pass = 0; pass < before.size(); ++pass) {
        if (!kept[pass])
            continue;
        const auto waitFor = [&](uint32_t other) {
            auto& list = before[pass];
            if (other != pass && kept[other] &&
                std::find(list.begin(), list.end(), other) == list.end())
                list.push_back(other);
        };
        for (const ResourceUse& use : graph.passes()[pass].uses) {
            if (use.readVersion != kNoVersion)
                if (const auto producer = versions.producer(use.resource, use.readVersion))
                    waitFor(*producer);
            if (use.writeVersion == kNoVersion)
                continue;
            // Culled versions in between leave gaps: the next older one that is made counts.
            for (uint32_t older = use.writeVersion; older-- > 0;) {
                for (uint32_t reader : versions.readers(use.resource, older))
                    waitFor(reader);
                const auto producer = versions.producer(use.resource, older);
                if (producer && kept[*producer]) {
                    waitFor(*producer);
                    break;
                }
            }
        }
    }
    return before;
}

/// Follows unfinished predecessors until a pass comes round again.
std::string nameCycle(
    const Graph& graph,
    const std::vector<std::vector<uint32_t>>& before,
    const std::vector<bool>& waits,
    uint32_t start
) {
    std::vector<uint32_t> path;
    uint32_t pass = start;
    while (std::find(path.begin(), path.end(), pass) == path.end()) {
        path.push_back(pass);
        pass = *std::find_if(before[pass].begin(), before[pass].end(), [&](uint32_t other) {
            return waits[other];
        });
    }
    std::string names;
    for (auto it = std::find(path.begin(), path.end(), pass); it != path.end(); ++it)
        names += fmt::format("'{}' waits for ", graph.passes()[*it].name);
    return names + fmt::format("'{}'", graph.passes()[pass].name);
}

} // namespace

core::Result<std::vector<uint32_t>>
orderPasses(const Graph& graph, const VersionTable& versions, const std::vector<bool>& kept) {
    const auto before = findPredecessors(graph, versions, kept);
    std::vector<std::vector<uint32_t>> after(before.size());
    std::vector<size_t> missing(before.size());
    std::priority_queue<uint32_t, std::vector<uint32_t>, std::greater<>> ready;
    for (uint32_t pass = 0; pass < before.size(); ++pass) {
        missing[pass] = before[pass].size();
        for (uint32_t other : before[pass])
            after[other].push_back(pass);
        if (kept[pass] && missing[pass] == 0)
            ready.push(pass);
    }
    std::vector<bool> waits = kept;
    std::vector<uint32_t> order;
    while (!ready.empty()) {
        const uint32_t pass = ready.top();
        ready.pop();
        order.push_back(pass);
        waits[pass] = false;
        for (uint32_t next : after[pass])
            if (--missing[next] == 0)
                ready.push(next);
    }
    if (const auto stuck = std::find(waits.begin(), waits.end(), true); stuck != waits.end())
        return core::makeError(
            "the passes form a cycle: {}",
            nameCycle(graph, before, waits, static_cast<uint32_t>(stuck - waits.begin()))
        );
    return order;
}

} // namespace shutter::graph
