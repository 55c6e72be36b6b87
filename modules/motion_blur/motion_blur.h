// SPDX-License-Identifier: MIT
// Motion blur as a post effect on a render graph: what an engine gives, what it gets.
//
// Conventions: colours are linear HDR, at most 65000. `motion` is a pixel's displacement in pixels
// (right, down) from shutter open to close, without temporal jitter; a camera rotation moves the
// sky too. `depth` is metres along the view direction, kSkyDepth (1e9) where nothing is. The mesh
// id is the row of the entity table, 0xFFFFFFFF where nothing is. All images have one size.
#pragma once

#include "engine/gpu/device.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/passes/block_filter.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/cost_view.h"
#include "modules/motion_blur/passes/gather.h"
#include "modules/motion_blur/passes/guertin_tiles.h"
#include "modules/motion_blur/passes/ray_mask.h"
#include "modules/motion_blur/passes/ray_reveal.h"
#include "modules/motion_blur/passes/revealed_layer.h"
#include "modules/motion_blur/passes/screen_filter.h"
#include "modules/motion_blur/passes/still_pixels.h"
#include "modules/motion_blur/passes/stochastic_rays.h"
#include "modules/motion_blur/passes/tile_motion.h"
#include "modules/motion_blur/settings.h"

#include <memory>
#include <optional>

namespace shutter::motion_blur {

struct MotionBlurInputs {
    graph::ImageHandle color;       ///< RGBA16F
    graph::ImageHandle motionDepth; ///< RGBA32F: motion.xy, depth; every value finite
    graph::ImageHandle normal;      ///< RGBA16F: xyz unit; read by the ray mask only
    graph::ImageHandle entityId;    ///< R32_UINT; read by mask and reveal only
    double rasterTime = 1.0;        ///< s of the raster instant: 0 start, 0.5 centre, 1 end
    glm::uvec2 response{
        0u}; ///< address of shader::ResponseTable (shutter_response_shared.h); 0: box
    std::optional<RayInputs> rays;           ///< Method::Hybrid needs them (CHECKed)
    std::optional<TimedRayInputs> timedRays; ///< Method::Denoised needs them (CHECKed)
    bool measureEdgesEverywhere = false; ///< fill the edge view beyond candidates (debug, slower)
    /// The colour image may be written in place: it is a transient, or was made with storage usage.
    /// Where little moves, still pixels are then not touched.
    bool colorIsWritable = false;
    /// Of the frames in flight, below gpu::kMaxFramesInFlight: no other frame that the GPU is not
    /// done with may have it.
    uint32_t slot = 0;
    /// Where the blurred picture shall stand: an image with storage and transfer usage that no
    /// other input is, or `color`, which must be writable then. Invalid: wherever it is cheapest.
    /// Method::Denoised does not read it.
    graph::ImageHandle target;
};

/// The blurred picture, and every intermediate for debug views; those of a method that did not run
/// are invalid handles. Views are drawn only if something reads them.
struct MotionBlurOutputs {
    graph::ImageHandle color;             ///< RGBA16F
    graph::ImageHandle tiles;             ///< RG32F, one texel a tile: longest motion
    graph::ImageHandle dominant;          ///< RG32F, one texel a tile: longest of the neighbourhood
    graph::ImageHandle variance;          ///< R32F, one texel a tile: Guertin's, [0, 1]
    graph::ImageHandle edge;              ///< RGBA8: candidate, edge measure, edge
    graph::ImageHandle mask;              ///< R8: 1 inside the ray mask
    graph::ImageHandle revealColor;       ///< RGBA16F: raster outside the mask
    graph::ImageHandle revealMotionDepth; ///< RGBA32F
    graph::ImageHandle revealEntityId;    ///< R32_UINT; written inside the mask only
    SortedBlocks blocks;                  ///< what the filters go over; not of Method::Denoised
    graph::ImageHandle cost;              ///< R32F: fetches a pixel; not of Method::Denoised
    graph::ImageHandle noisy;             ///< RGBA16F: the denoised method's rays, unfiltered
};

/// What the GPU counted in a frame.
struct MotionBlurCounters {
    uint32_t maskedPixels = 0;
    uint32_t raysTraced = 0;
    BlockCounters blocks; ///< of 8 x 8 pixels
};

/// Holds the pipelines; images belong to the graph.
class MotionBlur {
  public:
    /// \param sceneLayout layout of the descriptor set in RayInputs::scene; null: no rays, then
    /// Method::Hybrid and Method::Denoised cannot run
    MotionBlur(gpu::Device& device, VkDescriptorSetLayout sceneLayout);

    /// Declares the passes. Settings must be valid (CHECKed).
    MotionBlurOutputs
    add(graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurSettings& settings);

    /// Of the frame declared last for the slot, once the GPU is done with it.
    [[nodiscard]] MotionBlurCounters counters(uint32_t slot = 0) const;

  private:
    MotionBlurOutputs addGather(
        graph::Graph& graph, const MotionBlurInputs& inputs, const shader::MotionBlurParams& params
    );
    MotionBlurOutputs addHybrid(
        graph::Graph& graph, const MotionBlurInputs& inputs, const shader::MotionBlurParams& params
    );
    /// A filter of one pass over blocks of mixed motion, which all that move are to it.
    MotionBlurOutputs addRival(
        graph::Graph& graph,
        Method method,
        const MotionBlurInputs& inputs,
        const shader::MotionBlurParams& params
    );
    /// Reads no raster image.
    MotionBlurOutputs addDenoised(
        graph::Graph& graph,
        const MotionBlurInputs& inputs,
        const MotionBlurSettings& settings,
        const shader::MotionBlurParams& params
    ) const;
    void chooseStillPixelsBy(const MotionBlurInputs& inputs);

    TileMotion mTileMotion;
    BlockSorter mSorter;
    StillPixels mStillPixels;
    CostView mCostView;
    StillPixelsBy mStillPixelsBy = StillPixelsBy::WholeCopy;
    Gather mGather;
    BlockFilter mOwnVelocity;
    BlockFilter mMcGuire;
    GuertinTiles mGuertinTiles;
    BlockFilter mGuertin;
    BlockFilter mJimenez;
    ScreenFilter mVariance;
    ScreenFilter mATrous;
    std::unique_ptr<StochasticRays> mStochasticRays;
    std::unique_ptr<RayMask> mRayMask;
    std::unique_ptr<RayReveal> mRayReveal;
    std::unique_ptr<RevealedLayerPasses> mRevealedLayer;
};

} // namespace shutter::motion_blur
