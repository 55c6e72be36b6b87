// SPDX-License-Identifier: MIT
// Shadow maps on the device: lights' maps are cached and redrawn only when something in them has
// changed; movers' layers are drawn each frame.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/graph.h"
#include "modules/shadows/shadow_plan.h"

#include <cstdint>
#include <vector>

namespace shutter::shadows {

/// The pipelines of shadow maps; one set per scene, whose texture table they know.
struct ShadowPipelines {
    ShadowPipelines(gpu::Device& device, const gpu_scene::GpuScene& scene);

    gpu::Pipeline solid;
    gpu::Pipeline masked;
};

/// One for each raster of a frame in flight: the GPU must have finished the frame that it was last
/// prepared for.
class ShadowMaps {
  public:
    explicit ShadowMaps(gpu::Device& device) : mDevice(device) {}

    /// Makes the tables. \param plan with shadows
    /// Error: its maps do not fit an image of the device.
    core::Status prepare(ShadowPlan plan);

    /// Address of the prepared shader::ShadowConstants.
    [[nodiscard]] VkDeviceAddress constants() const { return mTables.address(); }

    /// Address of the prepared ShadowPlan::tiles.
    [[nodiscard]] VkDeviceAddress tiles() const { return mTables.address() + mTilesAt; }

    /// Declares the passes of the prepared plan. `frame` and `scene` must live until they have been
    /// recorded.
    /// \param shapes vertices of deformed meshes; invalid: there are none
    /// \return the buffer that shading reads with Access::ShaderRead
    [[nodiscard]] graph::BufferHandle declare(
        graph::Graph& graph,
        const ShadowPipelines& pipelines,
        const extract::ExtractedFrame& frame,
        const gpu_scene::GpuScene& scene,
        graph::BufferHandle shapes,
        VkDeviceAddress frameConstants
    );

  private:
    /// A map's place in the image that maps are drawn into.
    struct Drawn {
        uint32_t map = 0; ///< index of ShadowPlan::maps
        VkRect2D place{};
    };

    /// The contents of a cached map.
    struct Kept {
        math::dmat4 clipFromWorld{0.0};
        uint32_t sizePx = 0;
        uint32_t firstTexel = 0;
        uint64_t casterRevision = 0;

        bool operator==(const Kept&) const = default;
    };

    [[nodiscard]] Kept describe(const PlannedMap& map) const;
    [[nodiscard]] core::Status checkFit();
    /// Which maps have to be drawn, and where. \return the size of the image; 0: none has to be
    VkExtent2D placeMaps();
    /// Places those of mDrawn. \return the size of the image
    VkExtent2D placeDrawn();
    /// Places them in rows of that width, or of the width of the widest map. \return the extent
    VkExtent2D placeInRows(uint32_t width);
    /// Null: no map has to be drawn. Not a transient image of the graph: those share memory by
    /// plan, and each size of this one would make another plan.
    const gpu::Image* prepareImage(VkExtent2D size);

    gpu::Device& mDevice;
    ShadowPlan mPlan;
    gpu::Buffer mTables;       ///< mapped
    VkDeviceSize mTilesAt = 0; ///< in mTables
    gpu::Buffer mTexels;
    std::vector<Kept> mKept; ///< by index of the lights' maps
    std::vector<Drawn> mDrawn;
    std::vector<gpu::Image> mImages; ///< that maps are drawn into, the one used last at the end
};

} // namespace shutter::shadows
