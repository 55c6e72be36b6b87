// SPDX-License-Identifier: MIT
// What effects are given of a frame, in the order of its making: facts to decide by, the world to
// extract from, the graph to declare passes in, and what the GPU has finished.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/device.h"
#include "engine/gpu/frame.h"
#include "engine/gpu_scene/deformation_pass.h"
#include "engine/graph/graph.h"
#include "engine/graph/ray_scene.h"
#include "engine/render/frame_statistics.h"
#include "engine/render/gbuffer.h"
#include "engine/render/overlay_surfaces.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/world.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace shutter::render {

class Overlay;

/// Name of the measure on request: the largest channel value of a pixel in the linear picture that
/// is shown.
inline constexpr const char* kBrightest = "brightest channel";

/// What is known of a frame before effects decide.
struct ViewFacts {
    uint32_t width = 0;
    uint32_t height = 0;
    bool moves = false; ///< something in the picture, or the camera, moves
    double exposureSeconds = 0.0;
    bool usesLens = false;    ///< ViewRequest::usesLens
    bool isDefocused = false; ///< extract::isDefocused()
    double rasterTime = 1.0;  ///< s of the raster instant in the exposure, [0, 1]
    bool deviceHasRays = false;
    bool deviceHasRayQuery = false; ///< time-sampled rays can be traced
    /// Whether rays past movers could hit a surface (extract::decideReveal); skipped if nothing
    /// moves.
    core::Decision reveal;
    /// False: the frame is not shown; it is drawn only for the history of effects.
    bool pictureWanted = true;
    /// False: the next frame reads nothing of this one, and effects preserve their earlier
    /// history.
    bool isFollowed = true;
    /// Device counters of effects are read, beyond those that they need themselves.
    bool countersWanted = true;
    bool displayWanted = false; ///< a display-encoded picture is wanted, not only the linear one
    /// Light of the brightest channel of a pixel in the last picture that is known; nothing: none
    /// is.
    std::optional<float> lastBrightest;
    bool brightestWanted = false; ///< kBrightest of this picture is requested
};

/// Named intermediates that were requested (`--aov`).
class Intermediates {
  public:
    explicit Intermediates(std::set<std::string> wanted) : mWanted(std::move(wanted)) {}

    [[nodiscard]] bool isWanted(const std::string& name) const { return mWanted.contains(name); }

    /// Does nothing unless the name is wanted.
    void publish(const std::string& name, graph::ImageHandle image) {
        if (isWanted(name))
            mImages[name] = image;
    }

    [[nodiscard]] const std::map<std::string, graph::ImageHandle>& images() const {
        return mImages;
    }

  private:
    std::set<std::string> mWanted;
    std::map<std::string, graph::ImageHandle> mImages;
};

/// A raster of the world at another time, before it is drawn.
struct ExtractedRaster {
    const extract::ExtractedFrame* frame = nullptr;
    const extract::ViewRequest* view = nullptr; ///< what `frame` was extracted for
};

/// Access to the world for effects. Passes declared afterwards have none.
struct ExtractContext {
    const scene::World& world;
    const extract::ViewRequest& view;
    const scene::ExposureMotion& motion; ///< of the view's exposure
    const extract::ExtractedFrame& frame;
    const ViewFacts& facts;
    uint32_t slot = 0; ///< PictureContext::slot
    /// Rows whose blended surfaces are not in the raster, rising: an effect draws them.
    std::span<const uint32_t> takenRows{};
    /// Drawn at the exposure's other end (ViewRequest::instant); empty unless the effect reads it.
    std::optional<ExtractedRaster> secondRaster{};
    std::optional<ExtractedRaster> lastRaster{}; ///< of the previous frame; likewise
    /// Jitter of the colour that the effect gets: the raster's (ViewRequest::jitterPx), until an
    /// effect takes it out.
    math::dvec2 colorJitterPx{0.0};
    bool rasterHasOverlays = false; ///< an Overlay is drawn into its colour
    bool hasShading = false;        ///< entities change how others are shaded (ShadingFeature)
    uint64_t shadingRevision = 0;   ///< Shading::revision
};

/// A raster of the world at another time. Its pointers are valid as long as the graph.
struct OtherRasterView {
    GBuffer gbuffer;
    const extract::ExtractedFrame* frame = nullptr;
    gpu_scene::DeformedMeshes shapes;           ///< of `frame`
    const extract::ViewRequest* view = nullptr; ///< what `frame` was extracted for
};

struct PictureContext {
    graph::Graph& graph;
    const extract::ViewRequest& view;
    const extract::ExtractedFrame& frame;
    const gpu_scene::DeformedMeshes& shapes; ///< of `frame`
    const ViewFacts& facts;
    const GBuffer& gbuffer;
    const graph::RayScene* rays;       ///< null if no effect requested rays
    const graph::TimedRays* timedRays; ///< null if no effect requested time-sampled rays
    /// Drawn at the exposure's other end (ViewRequest::instant); null unless the effect reads it.
    const OtherRasterView* secondRaster = nullptr;
    const OtherRasterView* lastRaster = nullptr; ///< of the previous frame; likewise
    graph::ImageHandle color;                    ///< linear HDR so far; an effect replaces it
    graph::ImageHandle display{};                ///< display-encoded, once an effect has made it
    Intermediates& intermediates;
    std::span<const uint32_t> takenRows{};          ///< ExtractContext::takenRows
    std::span<const graph::BufferHandle> shading{}; ///< that the raster's shading read
    VkDeviceAddress response = 0;       ///< shader::ResponseTable of the shutter; 0: a box
    VkDeviceAddress frameConstants = 0; ///< shader::FrameConstants
    const shader::FrameConstants* constantValues = nullptr; ///< at that address
    Explainer& explainer; ///< takes reasons of passes that an effect leaves out
    uint32_t slot = 0;    ///< of the frames in flight, below gpu::kMaxFramesInFlight
    /// Semaphores of the frame's submission; set by an effect that draws on an image of the window
    /// system.
    gpu::SubmitSemaphores semaphores{};
    /// Rectangles whose surfaces overlays over the effect's picture read (OverlayLimits): the
    /// effect that has set Needs::exposure finds them. Empty for the others.
    std::span<const shader::InstantSurfaces> surfaces{};
    std::vector<graph::BufferHandle> surfaceWords{}; ///< set by it: OverlaySurfaces::words of each
    CompositeParts compositeParts{};                 ///< set by it with Needs::movingBlended
};

/// A frame that the GPU has finished, for one effect.
struct FinishedFrame {
    uint32_t slot = 0;                      ///< PictureContext::slot of it
    bool ran = false;                       ///< the effect declared passes for it
    std::span<const gpu::PassTime> passes;  ///< of those it declared
    Counters& counters;                     ///< receives the effect's counters, if it ran
    Measures& measures;                     ///< receives the effect's measures, if it ran
    std::vector<Explanation>& explanations; ///< takes what only those counts and measures explain
};

/// Inputs of an effect's decision.
struct DecideContext {
    const ViewFacts& facts;
    const scene::World& world;
    const extract::SceneLayout& layout;
    const extract::ViewRequest& view;
    const scene::ExposureMotion& motion; ///< of the view's exposure
    const extract::ExtractedFrame& frame;
    std::span<Overlay* const> overlays{};

    struct TakenRows {
        std::vector<uint32_t> rows;   ///< rising
        std::vector<Overlay*> takers; ///< that draw them
    };

    mutable std::array<std::optional<TakenRows>, 2> found{}; ///< by findTakenRows()

    /// Rows whose blended surfaces leave the raster for an effect with Needs::movingBlended
    /// (Overlay::findRows()); searched on the first call.
    [[nodiscard]] const TakenRows& findTakenRows(bool usesLens) const;
};

} // namespace shutter::render
