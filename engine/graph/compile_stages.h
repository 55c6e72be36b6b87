// SPDX-License-Identifier: MIT
// Private to engine/graph: the stages of compile(), each in the source file that its section names.
#pragma once

#include "engine/core/result.h"
#include "engine/graph/compile.h"
#include "engine/graph/types.h"

#include <optional>
#include <vector>

namespace shutter::graph {

// access.cpp: the table of accesses.

/// Vulkan's stages, access and layout for an access.
struct AccessScope {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 reads = 0;
    VkAccessFlags2 writes = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED; ///< images only
};

[[nodiscard]] AccessScope scopeOf(Access access, PassKind kind);
[[nodiscard]] bool fitsImage(Access access);
[[nodiscard]] bool fitsBuffer(Access access);
[[nodiscard]] bool fitsPass(Access access, PassKind kind);
/// Usage flag that an image or buffer needs for the access; 0 where its creator has to set it.
[[nodiscard]] VkImageUsageFlags imageUsageOf(Access access);
[[nodiscard]] VkBufferUsageFlags bufferUsageOf(Access access);

// order.cpp: which pass produces and which read each version, which passes are not culled, and
// their order.

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

/// A pass is not culled if it has a side effect, writes an imported resource or produces a version
/// that an output or another such pass needs.
[[nodiscard]] Culling cull(const Graph& graph, const VersionTable& versions);

/// Orders the passes that were not culled: each after the passes it depends on and before those
/// that overwrite its inputs; otherwise in declared order. Error: a cycle; names the passes on it.
[[nodiscard]] core::Result<std::vector<uint32_t>>
orderPasses(const Graph& graph, const VersionTable& versions, const std::vector<bool>& kept);

// validate.cpp: whether the declared frame can run.

/// Checks that need no culling: passes that will be culled are checked too. Errors name the pass
/// and the resource.
[[nodiscard]] core::Status checkDeclaration(const Graph& graph);

/// Outputs and resources that the host reads must exist when the frame ends.
[[nodiscard]] core::Status
checkResults(const Graph& graph, const VersionTable& versions, const std::vector<bool>& kept);

// alias.cpp: when each transient lives, and where images go in the memory that they share.

/// Fills Plan::images, Plan::buffers and the byte counts from the ordered passes: when each
/// transient lives, and its usage flags. Outputs live to the end of the frame.
void placeTransients(const Graph& graph, const RequirementFunction& requirement, Plan& plan);

/// Gives each image an offset in the block of memory that they share, so that no two that live at
/// the same time overlap: largest first, each at the lowest offset that fits. Returns the block's
/// size.
VkDeviceSize packImages(std::vector<Placement>& images);

[[nodiscard]] bool overlapInTime(const Placement& a, const Placement& b);
[[nodiscard]] bool overlapInMemory(const Placement& a, const Placement& b);

// barriers.cpp: what each pass must wait for.

/// Fills the barriers of a plan whose passes are ordered and whose images are placed.
///
/// The uses of a resource are grouped into runs: one write, or all reads up to the next write that
/// agree on the layout. Each run has one barrier before it, for all stages and accesses in the run:
/// - read after write, write after write, any change of layout: execution and memory;
/// - write after read: execution only, unless the write needs contents its stage has not seen;
/// - first use of a transient image: from UNDEFINED, after the last uses of every image that had
///   its memory before; nothing between frames, since each has its own pool and waits for the GPU;
/// - first use of an imported resource: after everything that an earlier submission may have
///   written.
void placeBarriers(const Graph& graph, Plan& plan, DisjointWrites disjoint);

} // namespace shutter::graph
