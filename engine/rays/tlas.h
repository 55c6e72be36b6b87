// SPDX-License-Identifier: MIT
// The top-level acceleration structures of rays at the raster instant. They are built when an
// instance changed, and what is static in the world may have one of its own, which few movers
// then leave as it is.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/acceleration_structure.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/graph.h"
#include "engine/rays/deformed_blas.h"
#include "engine/rays/instances.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace shutter::rays {

/// Fewest instances that are static in a level of their own: a ray goes through two levels then,
/// which costs more than building a small one anew does.
inline constexpr size_t kStaticTlasInstances = 256;

/// The levels of one frame.
struct TlasHandles {
    VkAccelerationStructureKHR level = VK_NULL_HANDLE;
    graph::BufferHandle buffer;         ///< read it with Access::AccelerationRead
    VkDeviceAddress movingTlas = 0;     ///< of a second level, with what moves; 0: there is none
    graph::BufferHandle movingBuffer;   ///< read it likewise, unless it is invalid
    graph::BufferHandle deformedBuffer; ///< levels of deformed meshes: likewise
};

class FrameTlas {
  public:
    explicit FrameTlas(gpu::Device& device) : mDevice(device), mDeformedBlas(device) {}

    /// Declares the builds that the frame calls for, of deformed meshes too. The GPU must be done
    /// with the last frame's. `scene` has its bottom levels, and is the same in every call.
    [[nodiscard]] TlasHandles declare(
        graph::Graph& graph,
        const extract::ExtractedFrame& frame,
        const gpu_scene::GpuScene& scene,
        const gpu_scene::DeformedMeshes& shapes
    );

  private:
    /// A level and what it was built of last, as it was listed.
    struct Level {
        gpu::Tlas level;
        std::vector<gpu::Instance> listed;
    };

    // True: the level has to be built.
    bool updateStill(const extract::ExtractedFrame& frame, const gpu_scene::GpuScene& scene);
    bool update(Level& level, const InstanceList& instances, bool force);

    void orderStill(const extract::ExtractedFrame& frame, const gpu_scene::GpuScene& scene);
    void listMoving(const extract::ExtractedFrame& frame, InstanceList& instances) const;
    /// \param build false: it is as it was
    graph::BufferHandle
    declareOne(graph::Graph& graph, const char* name, const Level& level, bool build) const;

    gpu::Device& mDevice;
    DeformedBlas mDeformedBlas;
    graph::BufferHandle mDeformedBlasBuffer; ///< of this frame
    Level mStill;                            ///< holds all, unless the movers are apart
    Level mMoving;
    std::optional<InstanceList> mMovingInstances;
    std::vector<uint32_t> mStillOrder; ///< rows that are static, in spatial order
    uint64_t mStillSet = 0;            ///< ExtractedFrame's, of mStillOrder
    uint64_t mStillRevision = 0;       ///< ExtractedFrame's, of mStill; 0: it holds others too
};

} // namespace shutter::rays
