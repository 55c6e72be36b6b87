// SPDX-License-Identifier: MIT
// Bottom levels of a frame's deformed meshes, for rays at the raster instant.
#pragma once

#include "engine/gpu/structure_set.h"
#include "engine/gpu_scene/deformation_pass.h"
#include "engine/graph/graph.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shutter::rays {

/// Refits between two builds: each lets the tree grow a little worse.
inline constexpr uint32_t kRefitsPerBuild = 15;

/// Refitted, refitted, ..., built anew: one level's turns. Those of a crowd that is first seen in
/// one frame are built anew in different frames later.
class RefitTurns {
  public:
    RefitTurns() = default;

    /// \param index of the level among those of its frame
    explicit RefitTurns(size_t index) : mRefits(uint32_t(index % (kRefitsPerBuild + 1))) {}

    /// What is to be done where the shape has changed.
    gpu::BuildAction take() {
        mRefits = mRefits < kRefitsPerBuild ? mRefits + 1 : 0;
        return mRefits > 0 ? gpu::BuildAction::Refit : gpu::BuildAction::Build;
    }

  private:
    uint32_t mRefits = 0; ///< since it was built from nothing, or taken to have been
};

/// One bottom level an entity of ExtractedFrame::deformed. What keeps its shape from one frame to
/// the next is kept; what changes it is refitted, and built anew now and then.
class DeformedBlas {
  public:
    explicit DeformedBlas(gpu::Device& device) : mDevice(device) {}

    /// Declares the builds. The GPU must be done with the last frame's.
    /// \return read it with Access::AccelerationRead; invalid: nothing is deformed
    [[nodiscard]] graph::BufferHandle declare(
        graph::Graph& graph,
        const extract::ExtractedFrame& frame,
        const gpu_scene::GpuScene& scene,
        const gpu_scene::DeformedMeshes& shapes
    );

    /// The structure of ExtractedFrame::deformed[index]; 0: it has no triangles.
    [[nodiscard]] VkDeviceAddress address(size_t index) const { return mAddresses[index]; }

    /// The last declare() declared a build: structures above have to be built too.
    [[nodiscard]] bool wasRebuilt() const { return mWasRebuilt; }

  private:
    /// What a level was built of last.
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
    gpu::StructureSet mLevels;
    std::vector<Built> mBuilt; ///< beside mLevels
    std::vector<VkDeviceAddress> mAddresses;
    bool mWasRebuilt = false;
};

} // namespace shutter::rays
