// SPDX-License-Identifier: MIT
// How an effect takes its place in a frame: it says whether the frame calls for it, then
// declares passes. The renderer knows no effect by name.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/device.h"
#include "engine/gpu/frame.h"
#include "engine/gpu_scene/deformation_pass.h"
#include "engine/graph/graph.h"
#include "engine/graph/ray_scene.h"
#include "engine/render/frame_statistics.h"
#include "engine/render/gbuffer.h"
#include "engine/render/particles.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/world.h"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace shutter::render {

/// Measure of a frame that was asked for it: light of the brightest channel of a pixel in the
/// linear picture that is shown.
inline constexpr const char* kBrightest = "brightest channel";

/// What an effect may base its decision on.
struct ViewFacts {
    uint32_t width = 0;
    uint32_t height = 0;
    bool moves = false; ///< something in the picture, or the camera, moves
    double exposureSeconds = 0.0;
    bool usesLens = false;   ///< ViewRequest::usesLens
    double rasterTime = 1.0; ///< s of the raster instant in the exposure, [0, 1]
    bool deviceHasRays = false;
    bool deviceHasRayQuery = false; ///< rays that each have their own time can be traced
    /// Whether rays past what moves could find a surface (extract::decideReveal); skipped where
    /// nothing moves.
    core::Decision reveal;
    /// False: the frame is drawn for what effects keep for the next one alone, and shown by none.
    bool pictureWanted = true;
    /// False: the frame after looks nothing up in this one, and what effects kept before stays.
    bool isFollowed = true;
    /// Somebody reads what effects count on the device, beyond what they need themselves.
    bool countersWanted = true;
    bool displayWanted = false; ///< a display-encoded picture is wanted, not only the linear one
    /// Light of the brightest channel of a pixel in the last picture that is known; nothing: none
    /// is.
    std::optional<float> lastBrightest;
    bool brightestWanted = false; ///< that light of this picture is to be measured (kBrightest)
};

/// Named intermediates that somebody asked to see (`--aov`).
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

/// What an effect may read of the world. Nothing that is declared afterwards sees it.
struct ExtractContext {
    const scene::World& world;
    const extract::ViewRequest& view;
    const scene::ExposureMotion& motion; ///< of the view's exposure
    const extract::ExtractedFrame& frame;
    const ViewFacts& facts;
    uint32_t slot = 0; ///< PostContext::slot
    /// Drawn at the exposure's other end (ViewRequest::instant); empty unless the effect reads it.
    std::optional<ExtractedRaster> secondRaster{};
    std::optional<ExtractedRaster> lastRaster{}; ///< of the frame before; likewise
    /// Jitter of the colour that the effect gets: the raster's (ViewRequest::jitterPx), until an
    /// effect takes it out.
    math::dvec2 colorJitterPx{0.0};
    bool rasterHasParticles = false; ///< they are drawn into its colour
    /// Changes whenever shadow maps of lights do. Shadows of movers with layers of their own are
    /// not in it: ShadowConstants::tiles bounds them.
    uint64_t shadowRevision = 0;
    /// What is drawn over the effect's picture (PostEffect::askParticles); null: nothing.
    const extract::ParticleTables* particles = nullptr;
};

/// A raster of the world at another time. What it points to lives as long as the graph.
struct OtherRasterView {
    GBuffer gbuffer;
    const extract::ExtractedFrame* frame = nullptr;
    gpu_scene::DeformedMeshes shapes;           ///< of `frame`
    const extract::ViewRequest* view = nullptr; ///< what `frame` was extracted for
};

struct PostContext {
    graph::Graph& graph;
    const extract::ViewRequest& view;
    const extract::ExtractedFrame& frame;
    const gpu_scene::DeformedMeshes& shapes; ///< of `frame`
    const ViewFacts& facts;
    const GBuffer& gbuffer;
    const graph::RayScene* rays;       ///< null where no effect asked for rays
    const graph::TimedRays* timedRays; ///< null where no effect asked for moving rays
    /// Drawn at the exposure's other end (ViewRequest::instant); null unless the effect reads it.
    const OtherRasterView* secondRaster = nullptr;
    const OtherRasterView* lastRaster = nullptr; ///< of the frame before; likewise
    graph::ImageHandle color;                    ///< linear HDR so far; an effect replaces it
    graph::ImageHandle display{};                ///< display-encoded, once somebody made it
    Intermediates& intermediates;
    graph::BufferHandle shadowMaps{};   ///< that the raster read; invalid: there are none
    VkDeviceAddress response = 0;       ///< shader::ResponseTable of the shutter; 0: a box
    VkDeviceAddress frameConstants = 0; ///< shader::FrameConstants
    Explainer& explainer;               ///< takes reasons of passes that an effect leaves out
    uint32_t slot = 0;                  ///< of the frames in flight, below gpu::kMaxFramesInFlight
    /// What the frame's submission waits for and signals; set by an effect that draws on an image
    /// of the window system.
    gpu::SubmitSemaphores semaphores{};
    /// What the particles that are drawn next are hidden by and lie over; set by an effect that
    /// found it.
    std::optional<ParticleInstants> particleInstants{};
};

/// A frame that the GPU is done with, as one effect sees it.
struct FinishedFrame {
    uint32_t slot = 0;                      ///< PostContext::slot of it
    bool ran = false;                       ///< the effect declared passes for it
    std::span<const gpu::PassTime> passes;  ///< of those it declared
    Counters& counters;                     ///< takes what the effect counted, if it ran
    Measures& measures;                     ///< takes what the effect measured, if it ran
    std::vector<Explanation>& explanations; ///< takes what only those counts and measures explain
};

class PostEffect {
  public:
    virtual ~PostEffect() = default;

    [[nodiscard]] virtual std::string name() const = 0;

    /// What its passes count as: PassOwner::Display for one that shows or keeps the picture,
    /// PassOwner::Blur for none but what blurs by motion or by the lens.
    [[nodiscard]] virtual PassOwner owner() const { return PassOwner::Other; }

    /// Pure: depends on the facts and the effect's settings only.
    [[nodiscard]] virtual core::Decision ask(const ViewFacts& facts) const = 0;

    /// Whether it traces rays at the raster instant; counts when it runs. Pure, as ask(). Without a
    /// reason it never does.
    [[nodiscard]] virtual core::Decision askRays(const ViewFacts&) const { return {}; }

    /// The same for rays at any time of the exposure.
    [[nodiscard]] virtual core::Decision askTimedRays(const ViewFacts&) const { return {}; }

    /// Whether it draws blended surfaces that move itself, after its own passes: those in
    /// ExtractedFrame::layerRows are in no raster then.
    [[nodiscard]] virtual core::Decision askLayer(const ViewFacts&) const { return {}; }

    /// The same for a raster of the world at the other end of the exposure
    /// (PostContext::secondRaster).
    [[nodiscard]] virtual core::Decision askSecondRaster(const ViewFacts&) const { return {}; }

    /// The same for the raster of the frame before, drawn once more (PostContext::lastRaster): for
    /// what did not keep it. It runs only where extract::makeViewBefore() finds that frame.
    /// The rasters of the context are not there yet.
    [[nodiscard]] virtual core::Decision askLastRaster(const ExtractContext&) const { return {}; }

    /// Whether it tells the surfaces at an edge apart (GBuffer::edgeSurface): colours there are of
    /// one surface then, and the mean of all samples else. Counts when it runs.
    [[nodiscard]] virtual bool readsEdges() const { return false; }

    /// Whether particles are drawn over its picture, on their way through the exposure, and not
    /// into the raster: whether or not it runs.
    [[nodiscard]] virtual core::Decision askParticles(const ViewFacts&) const { return {}; }

    /// Computes what the effect's passes need of the world; called only when ask() said run, for
    /// all effects of the frame in their order, before any declares passes.
    virtual void extract(ExtractContext&) {}

    /// Declares passes; called after extract().
    virtual void declare(PostContext& context) = 0;

    /// Called for each frame that the effect was asked about, in their order, once the GPU is done
    /// with it.
    virtual void finish(FinishedFrame&) {}
};

} // namespace shutter::render
