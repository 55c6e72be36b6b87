// SPDX-License-Identifier: MIT
// The top-level acceleration structures of rays at the raster instant. They are built when an
// instance changed, and what stands still in the world may have one of its own, which few movers
// then leave as it is.
#pragma once

#include "engine/gpu/acceleration_structure.h"
#include "engine/graph/graph.h"
#include "engine/render/extraction.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/instances.h"
#include "engine/render/shape_levels.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace shutter::render {

/// Fewest instances that stand still in a level of their own: a ray goes through two levels then,
/// which costs more than building a small one anew does.
inline constexpr size_t kStillLevelInstances = 256;

/// The levels of one frame.
struct TopLevelHandles {
    VkAccelerationStructureKHR level = VK_NULL_HANDLE;
    graph::BufferHandle buffer;       ///< read it with Access::AccelerationRead
    VkDeviceAddress movingLevel = 0;  ///< of a second level, with what moves; 0: there is none
    graph::BufferHandle movingBuffer; ///< read it likewise, unless it is invalid
    graph::BufferHandle shapesBuffer; ///< levels of bent meshes: likewise
};

class TopLevels {
  public:
    explicit TopLevels(gpu::Device& device) : mDevice(device), mShapeLevels(device) {}

    /// Declares the builds that the frame calls for, of bent meshes too. The GPU must be done with
    /// the last frame's. `scene` has its bottom levels, and is the same in every call.
    [[nodiscard]] TopLevelHandles declare(
        graph::Graph& graph,
        const ExtractedFrame& frame,
        const GpuScene& scene,
        const DeformedShapes& shapes
    );

  private:
    /// A level and what it was built of last, as it was listed.
    struct Level {
        gpu::TopLevel level;
        std::vector<gpu::Instance> listed;
    };

    // True: the level has to be built.
    bool updateStill(const ExtractedFrame& frame, const GpuScene& scene);
    bool update(Level& level, const InstanceList& instances, bool force);

    void orderStill(const ExtractedFrame& frame, const GpuScene& scene);
    void listMoving(const ExtractedFrame& frame, InstanceList& instances) const;
    /// \param build false: it is as it was
    graph::BufferHandle
    declareLevel(graph::Graph& graph, const char* name, const Level& level, bool build) const;

    gpu::Device& mDevice;
    ShapeLevels mShapeLevels;
    graph::BufferHandle mShapesBuffer; ///< of this frame
    Level mStill;                      ///< holds all, unless the movers are apart
    Level mMoving;
    std::optional<InstanceList> mMovingInstances;
    std::vector<uint32_t> mStillOrder; ///< rows that stand still, in spatial order
    uint64_t mStillSet = 0;            ///< ExtractedFrame's, of mStillOrder
    uint64_t mStillRevision = 0;       ///< ExtractedFrame's, of mStill; 0: it holds others too
};

} // namespace shutter::render
