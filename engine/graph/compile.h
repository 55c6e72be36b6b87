// SPDX-License-Identifier: MIT
// From a declared frame to a plan: what runs, in which order, with which barriers, and which
// transient images share memory. Pure: needs no device.
#pragma once

#include "engine/core/result.h"
#include "engine/graph/graph.h"

#include <functional>
#include <string>
#include <vector>

namespace shutter::graph {

struct ImageBarrier {
    uint32_t resource = 0;
    VkPipelineStageFlags2 srcStages = 0;
    VkAccessFlags2 srcAccess = 0;
    VkPipelineStageFlags2 dstStages = 0;
    VkAccessFlags2 dstAccess = 0;
    VkImageLayout oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImageLayout newLayout = VK_IMAGE_LAYOUT_UNDEFINED;
};

struct BufferBarrier {
    uint32_t resource = 0;
    VkPipelineStageFlags2 srcStages = 0;
    VkAccessFlags2 srcAccess = 0;
    VkPipelineStageFlags2 dstStages = 0;
    VkAccessFlags2 dstAccess = 0;
};

struct PlannedPass {
    uint32_t pass = 0;                         ///< index into Graph::passes()
    std::vector<ImageBarrier> imageBarriers;   ///< before the pass
    std::vector<BufferBarrier> bufferBarriers; ///< before the pass
};

/// Where a transient image or buffer lives while it is alive.
struct Placement {
    uint32_t resource = 0;
    uint32_t firstPass = 0;             ///< position in Plan::passes
    uint32_t lastPass = 0;              ///< position in Plan::passes, inclusive
    VkImageUsageFlags imageUsage = 0;   ///< images: from the accesses of the passes
    VkBufferUsageFlags bufferUsage = 0; ///< buffers: from the description and the accesses of the
                                        ///< passes
    VkDeviceSize bytes = 0;             ///< images: as the requirement function returns
    VkDeviceSize alignment = 1;
    VkDeviceSize offset = 0; ///< images: in the one block of memory they share
};

struct CulledPass {
    std::string name;
    std::string reason;
};

/// What execute() records. Unused resources do not appear in it.
struct Plan {
    std::vector<PlannedPass> passes;              ///< in execution order
    std::vector<ImageBarrier> finalImageBarriers; ///< imported images to their final layout
    std::vector<BufferBarrier> finalBufferBarriers;
    std::vector<Placement> images;  ///< transient images that are used
    std::vector<Placement> buffers; ///< transient buffers that are used (never aliased)
    std::vector<CulledPass> culled;
    VkDeviceSize blockBytes = 0;     ///< memory the aliased images need together
    VkDeviceSize unaliasedBytes = 0; ///< total without aliasing
};

struct MemoryRequirement {
    VkDeviceSize bytes = 0;
    VkDeviceSize alignment = 1;
};

using RequirementFunction =
    std::function<MemoryRequirement(const TransientImageDesc&, VkImageUsageFlags)>;

/// What Access::StorageWriteDisjoint gets.
enum class DisjointWrites : uint8_t {
    Overlap, ///< one barrier before the first of the passes
    /// A barrier before each: synchronization validation takes a storage image for written as a
    /// whole (https://github.com/KhronosGroup/Vulkan-ValidationLayers/issues/7093 has the like of
    /// buffers).
    Ordered,
};

/// Errors name the pass and the resource: a read of something never written, a write to an old
/// version, a cycle (such as an old version that is overwritten before it could be read), a handle
/// of another graph, attachments of different size, an access that does not fit the pass's kind or
/// the resource's (an image used as acceleration structure), a resource used twice by one pass in
/// ways that clash, an output that a later pass overwrites.
/// \param disjoint barriers between passes that write disjoint parts of an image
[[nodiscard]] core::Result<Plan> compile(
    const Graph& graph,
    const RequirementFunction& requirement,
    DisjointWrites disjoint = DisjointWrites::Overlap
);

/// Whether an image's contents are wanted after the pass at a position of the plan: by a later
/// pass, or outside of the frame. A target of which nothing is wanted need not be stored.
[[nodiscard]] bool
isWantedAfter(const Graph& graph, const Plan& plan, uint32_t resource, uint32_t position);

/// The plan as text for a person: passes in order with their reads and writes, barriers with
/// layouts, culled passes and why, images with size, format, lifetime and place in memory.
[[nodiscard]] std::string dump(const Graph& graph, const Plan& plan);

} // namespace shutter::graph
