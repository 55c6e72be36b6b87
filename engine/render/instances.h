// SPDX-License-Identifier: MIT
// Entities as instances of their meshes, for top-level acceleration structures.
#pragma once

#include "engine/gpu/acceleration_structure.h"
#include "engine/render/extraction.h"
#include "engine/render/gpu_scene.h"
#include "engine/render/spatial_order.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace shutter::render {

/// An entity whose mesh is bent.
struct BentInstance {
    uint32_t row = 0;
    uint32_t mesh = 0;
    bool mirrored = false;           ///< its vertices' winding is turned round
    VkDeviceAddress bottomLevel = 0; ///< of its shape; 0: left out
    math::Bounds bounds;             ///< object space
};

/// Instances and the boxes to order them by.
class InstanceList {
  public:
    explicit InstanceList(const GpuScene& scene) : mScene(scene) {}

    /// Leaves out meshes that no ray can meet and matrices that are singular or not finite: false.
    /// \param eyeFromObject rows of a 3x4 matrix
    /// \param solidMask bits of kSolidMask that its solid parts get
    bool
    add(uint32_t row,
        uint32_t mesh,
        const math::vec4 (&eyeFromObject)[3],
        uint32_t solidMask = shader::kSolidMask);
    bool
    add(const BentInstance& bent,
        const math::vec4 (&eyeFromObject)[3],
        uint32_t solidMask = shader::kSolidMask);
    void add(const gpu::Instance& instance, const Box& box);

    /// Empties it; the memory stays.
    void clear() {
        mInstances.clear();
        mBoxes.clear();
    }

    /// As they were added.
    [[nodiscard]] const std::vector<gpu::Instance>& instances() const { return mInstances; }

    /// computeSpatialOrder() of them.
    [[nodiscard]] std::vector<uint32_t> computeOrder() const { return computeSpatialOrder(mBoxes); }

    /// In an order that builders which keep it make a good tree of.
    [[nodiscard]] std::vector<gpu::Instance> order() const;

  private:
    bool
    place(gpu::Instance instance, const math::Bounds& bounds, const math::vec4 (&eyeFromObject)[3]);

    const GpuScene& mScene;
    std::vector<gpu::Instance> mInstances;
    std::vector<Box> mBoxes;
};

/// Culling and mask of a mesh's instances; placed at the origin.
[[nodiscard]] gpu::Instance describeInstance(const GpuScene& scene, uint32_t mesh);
[[nodiscard]] gpu::Instance describeInstance(const GpuScene& scene, const BentInstance& bent);

} // namespace shutter::render
