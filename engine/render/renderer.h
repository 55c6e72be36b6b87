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
#include "engine/render/frame_overlays.h"
#include "engine/render/frame_statistics.h"
#include "engine/render/frame_tables.h"
#include "engine/render/gbuffer.h"
#include "engine/render/longest_motion.h"
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

/// Longest motion in a picture during its exposure.
struct LongestPath {
    /// Longest motion in the picture of a visible point or of a shadow caster, which need not be
    /// visible; pixels. 0: nothing moves.
    double px = 0.0;
    bool movesLight = false;  ///< one that lights the picture does
    bool hasFleeting = false; ///< something appears, disappears or changes its colour
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

    /// Measures the shares of motion that remain under the view's cap
    /// (CameraShutter::maxBlurPercent): pass them to ExposureInterval::cap of everything drawn of
    /// this exposure. Draws the raster image up to four times; draws nothing without a cap.
    [[nodiscard]] core::Result<scene::MotionCap>
    measureMotionCap(const scene::World& world, const extract::ViewRequest& view);

    /// Measures the motion of the picture's points in the exposure. Measured on raster images, one
    /// for each part of the exposure (extract::planMotionParts); nothing is drawn where nothing
    /// moves.
    [[nodiscard]] core::Result<LongestPath> measureLongestPath(
        const scene::World& world,
        const extract::ViewRequest& view,
        std::span<const Overlay* const> overlays
    );

    [[nodiscard]] const gpu_scene::GpuScene& scene() const { return mScene; }

  private:
    /// What of a frame is read back: Readback's tickets.
    struct Tickets {
        std::optional<size_t> color;
        std::optional<size_t> display;
        std::map<std::string, size_t> intermediates;
        gpu::SubmitSemaphores semaphores; ///< of the submission
    };

    struct RunningEffect {
        Effect* effect = nullptr;
        bool readsSecondRaster = false;
        bool readsLastRaster = false;
        bool isBelowOverlays = false;
        size_t firstPass = 0; ///< its own passes: indices into Graph::passes()
        size_t endPass = 0;
    };

    /// The effects of a frame that run, and what rays they trace.
    struct RunningEffects {
        std::vector<RunningEffect> effects;
        core::Decision rays;
        core::Decision timedRays;
        core::Decision secondRaster;
        core::Decision lastRaster;
        core::Decision layer;
        std::vector<uint32_t> takenRows; ///< ExtractContext::takenRows
        bool mayTrace = false;           ///< in another frame, if not in this
        bool samplesEdges = false;       ///< the frame is drawn with several samples per pixel
        bool readsEdges = false;         ///< Needs::edges of one of them
        bool readsNormals = false;       ///< Needs::normals likewise
        /// GBufferPass::Source::confusion.
        math::vec2 confusion{0.0f};
        /// Needs::exposure; run: overlays are drawn after as many of the effects as overlaysAt.
        core::Decision exposure;
        size_t overlaysAt = 0;
        OverlayLimits limits; ///< of the effect below them, if that runs
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
        const FrameOverlays& overlays;
        math::dvec2 overlayJitterPx; ///< of the colour that they are drawn on
        RunningEffects& running;
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

    /// Draws the view's motion in a separate frame. \return pixels from open to close, one number
    /// per row, then the sky's
    core::Result<std::vector<float>>
    drawMotion(const scene::World& world, const extract::ViewRequest& view);
    /// Extracts a frame. Under a lens that spreads something, no samples of static surfaces are
    /// gathered: each frame has several per pixel instead, so that a static picture does not change
    /// from frame to frame, and bright points keep their light.
    [[nodiscard]] core::Result<OwnFrame>
    extractOwn(const scene::World& world, const extract::ViewRequest& view, bool hasEffects);
    /// Joins what the effects of a frame need.
    static RunningEffects
    joinNeeds(const DecideContext& context, std::span<Effect* const> effects, Explainer& explainer);
    /// Extracts the additional rasters of the running effects and calls their extract().
    [[nodiscard]] core::Status extractForEffects(
        ExtractContext& context,
        const RunningEffects& running,
        std::span<ShadingFeature* const> shading
    );
    /// Extracts the overlays that the frame draws.
    [[nodiscard]] core::Result<FrameOverlays> extractOverlays(
        const ExtractContext& context,
        std::span<Overlay* const> overlays,
        const RunningEffects& running
    ) const;
    static OverlayContext
    makeOverlayContext(const FrameParts& parts, const DeclaredScene& scene, uint32_t slot);
    Tickets declareFrame(const FrameParts& parts);
    /// All up to the frame's own G-buffer.
    DeclaredScene declareScene(const FrameParts& parts);
    void
    declareEffects(const FrameParts& parts, const DeclaredScene& scene, PictureContext& context);
    static std::vector<PendingEffect> listPending(
        std::span<Effect* const> effects, const RunningEffects& running, const graph::Plan& plan
    );
    /// Frees resources that no frame used for a while.
    void releaseIdle(const RunningEffects& running);

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
    std::deque<PendingFrame> mPending;           ///< oldest first
    std::optional<LongestMotion> mLongestMotion; ///< made by the first cap
    // Statistics of the frame declared last.
    gpu_scene::EntityTable::Written mWritten;
    double mTableMilliseconds = 0.0;
    double mTlasMilliseconds = 0.0;
};

} // namespace shutter::render
