// SPDX-License-Identifier: MIT
// Entities as instances of their meshes, for top-level acceleration structures.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/extract/spatial_order.h"
#include "engine/gpu/acceleration_structure.h"
#include "engine/gpu_scene/gpu_scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace shutter::rays {

/// An entity whose mesh is deformed.
struct DeformedInstance {
    uint32_t row = 0;
    uint32_t mesh = 0;
    bool mirrored = false;    ///< its vertices' winding is reversed
    VkDeviceAddress blas = 0; ///< of its shape; 0: left out
    math::Bounds bounds;      ///< object space
};

/// Instances and the boxes to order them by.
class InstanceList {
  public:
    explicit InstanceList(const gpu_scene::GpuScene& scene) : mScene(scene) {}

    /// Adds an instance. Returns false for meshes that no ray can hit and for matrices that are
    /// singular or not finite.
    /// \param relWorldFromObject rows of a 3x4 matrix
    /// \param solidMask bits of kSolidMask that its solid parts get
    bool
    add(uint32_t row,
        uint32_t mesh,
        const math::vec4 (&relWorldFromObject)[3],
        uint32_t solidMask = shader::kSolidMask);
    bool
    add(const DeformedInstance& deformed,
        const math::vec4 (&relWorldFromObject)[3],
        uint32_t solidMask = shader::kSolidMask);
    void add(const gpu::Instance& instance, const extract::Box& box);

    /// Empties it without freeing memory.
    void clear() {
        mInstances.clear();
        mBoxes.clear();
    }

    /// As they were added.
    [[nodiscard]] const std::vector<gpu::Instance>& instances() const { return mInstances; }

    /// computeSpatialOrder() of them.
    [[nodiscard]] std::vector<uint32_t> computeOrder() const {
        return extract::computeSpatialOrder(mBoxes);
    }

    /// Returns them in an order of which order-preserving builders make a good tree.
    [[nodiscard]] std::vector<gpu::Instance> order() const;

  private:
    bool place(
        gpu::Instance instance,
        const math::Bounds& bounds,
        const math::vec4 (&relWorldFromObject)[3]
    );

    const gpu_scene::GpuScene& mScene;
    std::vector<gpu::Instance> mInstances;
    std::vector<extract::Box> mBoxes;
};

/// As GpuScene::describeInstance, with the deformed BLAS and winding.
[[nodiscard]] gpu::Instance
describeInstance(const gpu_scene::GpuScene& scene, const DeformedInstance& deformed);

} // namespace shutter::rays
