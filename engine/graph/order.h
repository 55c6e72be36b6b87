// SPDX-License-Identifier: MIT
// Who makes and who reads each version; which passes stay; in which order they run.
#pragma once

#include "engine/core/result.h"
#include "engine/graph/compile.h"

#include <optional>
#include <vector>

namespace shutter::graph {

/// The passes behind each (resource, version).
class VersionTable {
  public:
    explicit VersionTable(const Graph& graph);

    [[nodiscard]] std::optional<uint32_t> producer(uint32_t resource, uint32_t version) const;
    /// Passes that need its contents, in declared order.
    [[nodiscard]] const std::vector<uint32_t>& readers(uint32_t resource, uint32_t version) const;

  private:
    struct Version {
        std::optional<uint32_t> producer;
        std::vector<uint32_t> readers;
    };

    std::vector<std::vector<Version>> mVersions; ///< [resource][version]
};

struct Culling {
    std::vector<bool> kept; ///< by pass
    std::vector<CulledPass> culled;
};

/// A pass stays if it has a side effect, writes an imported resource or makes a version that an
/// output or a pass that stays needs.
[[nodiscard]] Culling cull(const Graph& graph, const VersionTable& versions);

/// The passes that stay, each after what it needs and before what overwrites it; otherwise as
/// declared. Error: a cycle, with the passes on it.
[[nodiscard]] core::Result<std::vector<uint32_t>>
orderPasses(const Graph& graph, const VersionTable& versions, const std::vector<bool>& kept);

} // namespace shutter::graph
