// SPDX-License-Identifier: MIT
// The top-level acceleration structures of rays at the raster instant. They are rebuilt when an
// instance changed. Static instances may have a TLAS of their own, so that it need not be rebuilt
// for movers.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/extract/instance_masks.h"
#include "engine/gpu/acceleration_structure.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/graph.h"
#include "engine/rays/deformed_blas.h"
#include "engine/rays/instances.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace shutter::rays {

/// Minimum number of instances for a separate static TLAS: rays then traverse two, which costs more
/// than rebuilding a small one.
inline constexpr size_t kStaticTlasInstances = 256;

/// The TLASes of one frame.
struct TlasHandles {
    VkAccelerationStructureKHR level = VK_NULL_HANDLE;
    graph::BufferHandle buffer;         ///< read it with Access::AccelerationRead
    VkDeviceAddress movingTlas = 0;     ///< of the second TLAS, with the movers; 0: there is none
    graph::BufferHandle movingBuffer;   ///< read it likewise, unless it is invalid
    graph::BufferHandle deformedBuffer; ///< BLASes of deformed meshes: likewise
};

/// A frame, and the masks by which rays exclude its instances.
struct MaskedFrame {
    const extract::ExtractedFrame& frame;
    std::span<const extract::RowMask> masks; ///< of assignInstanceMasks()
};

class FrameTlas {
  public:
    explicit FrameTlas(gpu::Device& device) : mDevice(device), mDeformedBlas(device) {}

    /// Declares the builds that the frame calls for, of deformed meshes too. The GPU must have
    /// finished with the last frame's. `scene` has built its BLASes, and is the same in every call.
    [[nodiscard]] TlasHandles declare(
        graph::Graph& graph,
        const MaskedFrame& masked,
        const gpu_scene::GpuScene& scene,
        const gpu_scene::DeformedMeshes& shapes
    );

  private:
    /// A TLAS and the instances of its last build.
    struct Level {
        gpu::Tlas level;
        std::vector<gpu::Instance> listed;
    };

    // True: the TLAS has to be built.
    bool updateStill(const MaskedFrame& masked, const gpu_scene::GpuScene& scene);
    bool update(Level& level, const InstanceList& instances, bool force);

    void orderStill(const MaskedFrame& masked, const gpu_scene::GpuScene& scene);
    void listMoving(const MaskedFrame& masked, InstanceList& instances) const;
    /// \param build false: it is unchanged
    graph::BufferHandle
    declareOne(graph::Graph& graph, const char* name, const Level& level, bool build) const;

    gpu::Device& mDevice;
    DeformedBlas mDeformedBlas;
    graph::BufferHandle mDeformedBlasBuffer; ///< of this frame
    Level mStill;                            ///< holds all, unless the movers are separate
    Level mMoving;
    std::optional<InstanceList> mMovingInstances;
    std::vector<uint32_t> mStillOrder; ///< rows that are static, in spatial order
    uint64_t mStillSet = 0;            ///< ExtractedFrame's, of mStillOrder
    uint64_t mStillRevision = 0;       ///< ExtractedFrame's, of mStill; 0: it holds others too
};

} // namespace shutter::rays
