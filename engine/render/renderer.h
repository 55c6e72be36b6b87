// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/extract/extracted_frame.h"
#include "engine/extract/frame_extractor.h"
#include "engine/gpu/frame.h"
#include "engine/gpu_scene/deformation_pass.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/transient_pool.h"
#include "engine/image/image.h"
#include "engine/rays/timed_scene.h"
#include "engine/rays/tlas.h"
#include "engine/render/effect.h"
#include "engine/render/frame_needs.h"
#include "engine/render/frame_overlays.h"
#include "engine/render/frame_statistics.h"
#include "engine/render/frame_tables.h"
#include "engine/render/gbuffer.h"
#include "engine/render/other_raster.h"
#include "engine/render/pass_trace.h"
#include "engine/render/per_slot.h"
#include "engine/render/readback.h"
#include "engine/render/shading_feature.h"

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace shutter::render {

struct FrameRequest {
    extract::ViewRequest view;
    std::set<std::string> intermediates; ///< names to read back; unknown ones are not in the result
    /// Names that an effect shows: made although they are not read back.
    std::set<std::string> shownIntermediates;
    bool wantColor = true;    ///< read the linear picture back
    bool wantDisplay = false; ///< read the display-encoded picture back
    /// An effect shows the display-encoded picture: it is made although it is not read back.
    bool showsDisplay = false;
    /// False: the frame is not shown. Effects only store history for the next frame.
    bool wantPicture = true;
    /// False: the next frame reads nothing of this one. Effects preserve their earlier history.
    bool isFollowed = true;
    /// A measurement, not a frame of the picture: idle resources are not freed.
    bool measuresMotion = false;
    bool wantDump = false;  ///< describe the graph in FrameResult::dump
    bool wantTrace = false; ///< copy the outputs of each pass to FrameResult::trace
    /// False: effects may skip their device counters; FrameStatistics::counters may lack them.
    bool wantCounters = true;
    /// Measure kBrightest, which later frames may get as lastBrightest, if there is a
    /// display-encoded picture.
    bool wantBrightest = false;
    /// ViewFacts::lastBrightest. A picture that depends on it depends on those drawn before.
    std::optional<float> lastBrightest{};
    /// Record the reason for each pass and for the frame's own work; effects always record theirs.
    bool wantReasons = false;
};

/// What a frame is drawn with, in order.
struct FeatureSet {
    std::span<ShadingFeature* const> shading{};
    std::span<Overlay* const> overlays{};
    std::span<Effect* const> effects{};
};

struct FrameResult {
    image::Image color;   ///< linear, RGBA; empty unless wanted
    image::Image display; ///< [0, 1], RGBA; empty unless wanted
    std::map<std::string, image::Image> intermediates;
    FrameStatistics statistics;
    std::string dump;
    std::vector<WrittenImage> trace;
};

/// Draws frames of one world's assets; features are the caller's. Frames are submitted and finished
/// in order: sequentially with one frame in flight, with more the CPU runs ahead of the GPU.
class Renderer {
  public:
    /// \param framesInFlight [1, gpu::kMaxFramesInFlight]. Each one has its own tables and
    /// acceleration structures; with more than one, tables are written whole in each frame in which
    /// a row changes
    Renderer(gpu::Device& device, const scene::Assets& assets, uint32_t framesInFlight = 1);
    ~Renderer();

    /// Records and submits a frame. As many as are in flight may be unfinished (CHECKed).
    [[nodiscard]] core::Status
    submitFrame(const scene::World& world, const FrameRequest& request, const FeatureSet& features);

    /// Waits for the oldest frame that is unfinished (CHECKed: there is one), whose features must
    /// still be there.
    [[nodiscard]] FrameResult finishFrame();

    [[nodiscard]] size_t unfinishedCount() const { return mPending.size(); }

    [[nodiscard]] uint32_t framesInFlight() const { return static_cast<uint32_t>(mSlots.size()); }

    /// Submits and finishes a frame; none may be unfinished (CHECKed).
    [[nodiscard]] core::Result<FrameResult>
    renderFrame(const scene::World& world, const FrameRequest& request, const FeatureSet& features);

    [[nodiscard]] const gpu_scene::GpuScene& scene() const { return mScene; }

  private:
    /// Passes of an effect: indices into Graph::passes().
    struct EffectPasses {
        Effect* effect = nullptr;
        size_t first = 0;
        size_t end = 0;
    };

    /// What is taken of a frame: Readback's tickets, and whose its passes are.
    struct Tickets {
        std::vector<EffectPasses> effects; ///< of those that run
        std::optional<size_t> color;
        std::optional<size_t> display;
        std::map<std::string, size_t> intermediates;
        gpu::SubmitSemaphores semaphores; ///< of the submission
    };

    /// The extracted frame, and the view that it was drawn for.
    struct OwnFrame {
        extract::ViewRequest view;
        const extract::ExtractedFrame* frame = nullptr;
        bool isDefocused = false; ///< ViewFacts::isDefocused
    };

    /// Resources of one frame in flight.
    struct Slot {
        explicit Slot(gpu::Device& device) : frame(device), readback(device), tables(device) {}

        gpu::Frame frame;
        Readback readback;
        FrameTables tables;
    };

    /// Inputs of declaring a frame.
    struct FrameParts {
        Slot& slot;
        graph::Graph& graph;
        const FrameRequest& request;
        const ViewFacts& facts;
        const extract::ExtractedFrame& frame;
        const RasterShading& shading;       ///< of the own raster
        const extract::TimedTables* moving; ///< null: no time-sampled rays
        const FrameOverlays& inRaster;      ///< overlays that are drawn into its colour
        const FrameOverlays& over;          ///< over an effect's picture
        math::dvec2 overJitterPx;           ///< of that
        const FrameNeeds& needs;
        math::vec2 confusion; ///< GBufferPass::Source::confusion
        Explainer& explainer;
    };

    /// What effects find of a frame.
    struct DeclaredScene {
        gpu_scene::DeformedMeshes shapes;
        graph::RayScene rays;       ///< filled where an effect traces at the raster instant
        graph::TimedRays timedRays; ///< likewise at any time
        FrameTables::Addresses tables;
        GBuffer gbuffer;
    };

    /// An effect of an unfinished frame, and the range of its pass times.
    struct PendingEffect {
        Effect* effect = nullptr;
        bool ran = false;
        std::vector<size_t> times;
    };

    /// A frame that was submitted and not finished.
    struct PendingFrame {
        uint32_t slot = 0;
        double startMilliseconds = 0.0;
        Tickets tickets;
        PassTrace trace; ///< empty unless wanted
        std::vector<PendingEffect> effects;
        std::vector<PassOwner> owners; ///< per pass, in execution order
        FrameResult result;            ///< results that do not depend on the GPU
    };

    /// Extracts a frame. Under a lens that spreads something, no samples of static surfaces are
    /// gathered: each frame has several per pixel instead, so that a static picture does not change
    /// from frame to frame, and bright points keep their light.
    [[nodiscard]] core::Result<OwnFrame>
    extractOwn(const scene::World& world, const extract::ViewRequest& view, bool hasEffects);
    /// Extracts the additional rasters of the running effects and calls their extract().
    [[nodiscard]] core::Status extractForEffects(
        ExtractContext& context, const FrameNeeds& needs, std::span<ShadingFeature* const> shading
    );
    [[nodiscard]] OverlayExtract
    describeOverlays(const ExtractContext& context, const FrameNeeds& needs) const;
    [[nodiscard]] OverlayContext makeOverlayContext(
        const FrameParts& parts, const DeclaredScene& scene, const math::dvec2& jitterPx
    ) const;
    Tickets declareFrame(const FrameParts& parts);
    /// All up to the frame's own G-buffer.
    DeclaredScene declareScene(const FrameParts& parts);
    [[nodiscard]] std::vector<EffectPasses>
    declareEffects(const FrameParts& parts, const DeclaredScene& scene, PictureContext& context);
    /// Frees resources that no frame used for a while.
    void releaseIdle(const FrameNeeds& needs);

    /// \return the address for FrameConstants::movingTlas
    VkDeviceAddress declareTlas(
        graph::Graph& graph,
        const rays::MaskedFrame& frame,
        const gpu_scene::DeformedMeshes& shapes,
        graph::RayScene& rays
    );
    void publishGBuffer(const GBuffer& gbuffer, Intermediates& intermediates) const;

    gpu::Device& mDevice;
    gpu_scene::GpuScene mScene;
    GBufferPass mGBufferPass;
    graph::TransientPool mPool; ///< of all frames: they do not overlap on the GPU
    extract::FrameExtractor mExtractor;
    bool mWasDefocused = false;                ///< the last frame
    std::vector<std::unique_ptr<Slot>> mSlots; ///< one per frame in flight
    uint32_t mNextSlot = 0;
    PerSlot<gpu_scene::DeformationPass> mDeformation;
    PerSlot<rays::FrameTlas> mFrameTlas;
    PerSlot<rays::TimedScene> mTimedScene;
    PerSlot<OtherRaster> mSecondRaster;
    PerSlot<OtherRaster> mLastRaster;
    std::deque<PendingFrame> mPending; ///< oldest first
    // Statistics of the frame declared last.
    gpu_scene::EntityTable::Written mWritten;
    double mTableMilliseconds = 0.0;
    double mTlasMilliseconds = 0.0;
};

} // namespace shutter::render
