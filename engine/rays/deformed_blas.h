// SPDX-License-Identifier: MIT
// BLASes of a frame's deformed meshes, for rays at the raster instant.
#pragma once

#include "engine/gpu/structure_set.h"
#include "engine/gpu_scene/deformation_pass.h"
#include "engine/graph/graph.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shutter::rays {

/// Refits between two builds: each refit degrades the tree a little.
inline constexpr uint32_t kRefitsPerBuild = 15;

/// Schedules the refits and rebuilds of one BLAS. BLASes that are first built in the same frame are
/// rebuilt in different frames later.
class RefitTurns {
  public:
    RefitTurns() = default;

    /// \param index of the BLAS among those of its frame
    explicit RefitTurns(size_t index) : mRefits(uint32_t(index % (kRefitsPerBuild + 1))) {}

    /// Returns the action for a changed shape.
    gpu::BuildAction take() {
        mRefits = mRefits < kRefitsPerBuild ? mRefits + 1 : 0;
        return mRefits > 0 ? gpu::BuildAction::Refit : gpu::BuildAction::Build;
    }

  private:
    uint32_t mRefits = 0; ///< since the last rebuild, real or assumed
};

/// One BLAS per entity of ExtractedFrame::deformed. Unchanged shapes are reused; changed shapes are
/// refitted, and rebuilt at intervals.
class DeformedBlas {
  public:
    explicit DeformedBlas(gpu::Device& device) : mDevice(device) {}

    /// Declares the builds. The GPU must have finished with the last frame's.
    /// \return read it with Access::AccelerationRead; invalid: nothing is deformed
    [[nodiscard]] graph::BufferHandle declare(
        graph::Graph& graph,
        const extract::ExtractedFrame& frame,
        const gpu_scene::GpuScene& scene,
        const gpu_scene::DeformedMeshes& shapes
    );

    /// The structure of ExtractedFrame::deformed[index]; 0: it has no triangles.
    [[nodiscard]] VkDeviceAddress address(size_t index) const { return mAddresses[index]; }

    /// The last declare() declared a build: the TLAS has to be built too.
    [[nodiscard]] bool wasRebuilt() const { return mWasRebuilt; }

  private:
    /// The inputs of a BLAS's last build.
    struct Built {
        ecs::Entity entity;
        uint32_t mesh = 0;
        scene::Deformation pose;
        RefitTurns turns;
    };

    /// \param index of the level
    gpu::BuildAction
    choose(size_t index, const extract::DeformedEntity& entity, ecs::Entity handle);

    gpu::Device& mDevice;
    gpu::StructureSet mBlases;
    std::vector<Built> mBuilt; ///< parallel to mBlases
    std::vector<VkDeviceAddress> mAddresses;
    bool mWasRebuilt = false;
};

} // namespace shutter::rays
