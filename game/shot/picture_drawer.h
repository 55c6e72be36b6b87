// SPDX-License-Identifier: MIT
// Draws one picture by any method, in any number of frames: raster with a filter is one frame, or
// one for each part of the exposure where something jumps; an average of instants or of batches of
// rays is many.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/exposure_parts.h"
#include "engine/render/motion_measures.h"
#include "engine/render/renderer.h"
#include "game/shot/picture_features.h"
#include "game/shot/shot.h"
#include "game/shot/shot_options.h"
#include "modules/accumulate/accumulate.h"
#include "modules/depth_of_field/depth_of_field.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "modules/taa/taa.h"
#include "modules/truth/truth.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace shutter::game {

/// Number of instants that accumulate averages, if it depends on the frame's motion.
struct InstantChoice {
    uint32_t count = 1;
    double stepPx = 0.0; ///< maximum motion between two instants
    std::string reason;  ///< a clause
};

/// Instants of a frame in which a light moves or something flashes, at least: that moves no point,
/// but colours change.
inline constexpr uint32_t kMinInstantsOfLight = 16;

/// As few as keep the step, 1 where nothing moves.
/// \param maxStepPx above 0
/// \param most above 0; where it is not enough, the step is longer
[[nodiscard]] InstantChoice
chooseInstants(const render::LongestPath& path, double maxStepPx, uint32_t most);

struct PictureRequest {
    render::FrameRequest frame;
    /// The exposure's cap; nothing: the drawer measures it (measureCap).
    std::optional<scene::MotionCap> cap{};
    MethodOptions method;
    bool filtersLens = false; ///< MethodInfo::lensFilter runs
    /// With MethodOptions::maxStepPx; nothing: the drawer measures the motion.
    std::optional<InstantChoice> instants{};
    FeatureSettings features{};
    extract::PixelModel pixel = extract::PixelModel::Centre; ///< accumulate, truth
    uint32_t seed = 0;                              ///< accumulate, truth, AntiAliasing::Box
    AntiAliasing antiAliasing = AntiAliasing::None; ///< unless isSampledAnyway()
    uint32_t raysPerFrame = 0; ///< truth: maximum rays per pixel in one frame; 0: depends on the
                               ///< device
    /// truth: rays per pixel that the slot's last picture, of the same view, was left with; the
    /// method's samples, then 0 or more, are added to them.
    uint32_t raysBefore = 0;
    /// While the blur's pipelines are still being created: wait for them, or use another method.
    motion_blur::UntilReady untilReady = motion_blur::UntilReady::Wait;
    /// Draws the previous frames first for a method with lookups in the last one, and for
    /// AntiAliasing::Taa, unless the slot drew the last one already. Only their history is drawn:
    /// no blur, rays or second raster. False: sample places in the pixel follow the order of
    /// drawing.
    bool drawsFramesBefore = true;
    /// Of MethodFamily::MotionBlur; the drawer finds them.
    std::vector<extract::ExposurePart> exposureParts{};
    /// Effects after the method's own, e.g. the tone map. Must live until the picture is finished.
    /// With FrameRequest::wantBrightest, they receive the measure of the slot's last finished
    /// picture.
    std::vector<render::Effect*> ending;
    /// Below PictureDrawer::kSlots. Pictures that are drawn side by side, each again and again, use
    /// different slots, so that neither disturbs the history of the other's effects.
    uint32_t slot = 0;
};

/// A method with its own number of samples. \param settings of MethodFamily::MotionBlur; its method
/// is set here, and its sample count where that is 0
[[nodiscard]] MethodOptions
makeMethod(const MethodInfo& method, const motion_blur::MotionBlurSettings& settings = {});

/// Frames of AntiAliasing::Box.
inline constexpr uint32_t kBoxFrames = 16;

/// Whether the method takes many samples per pixel itself (extract::PixelModel), so that
/// AntiAliasing does not apply.
[[nodiscard]] bool isSampledAnyway(const MethodInfo& method);

/// What `--aov all` reads back of the method's pictures.
[[nodiscard]] std::set<std::string> listIntermediates(const MethodInfo& method);

/// The shot's picture at `seconds` by a method, without anything after the method's own effect.
[[nodiscard]] PictureRequest makePicture(
    const Shot& shot, const ShotOptions& options, const MethodOptions& method, double seconds
);

/// Intermediate pictures of a progressive method.
struct Checkpoints {
    std::vector<uint32_t> rays; ///< per pixel, above 0, in any order; those above the samples never
                                ///< come
    /// The picture so far in the wanted encodings (no intermediates), with the times summed so
    /// far. Called for the last picture too if its rays are among `rays`.
    std::function<void(uint32_t rays, const render::FrameResult& picture)> onPicture;
};

struct FinishedPicture {
    uint32_t slot = 0;
    render::FrameResult result; ///< times and counters are summed over the picture's frames
};

/// Draws pictures with the effects that their methods are made of, which are made when first used.
class PictureDrawer {
  public:
    static constexpr uint32_t kSlots = 2;

    /// \param renderer outlives this; several drawers may share it, one after the other
    PictureDrawer(gpu::Device& device, render::Renderer& renderer);
    ~PictureDrawer();
    PictureDrawer(const PictureDrawer&) = delete;
    PictureDrawer& operator=(const PictureDrawer&) = delete;

    /// Error: the device cannot run the method or draw the size. Names --method or --size.
    [[nodiscard]] static core::Status
    check(const gpu::Device& device, const MethodOptions& method, uint32_t width, uint32_t height);

    /// How often draw() calls onStep: frames of accumulate and of AntiAliasing::Box, rays per pixel
    /// of truth, else 1; also if the number of frames depends on the picture
    /// (MethodOptions::maxStepPx).
    [[nodiscard]] static uint32_t
    countSteps(const MethodOptions& method, AntiAliasing antiAliasing = AntiAliasing::None);

    /// Measures the cap of the view's shutter, for pictures that share a view. Finishes all frames
    /// if there is a cap to measure.
    [[nodiscard]] core::Result<scene::MotionCap>
    measureCap(const scene::World& world, const extract::ViewRequest& view);

    /// Chooses the instants of a picture with MethodOptions::maxStepPx (PictureRequest::instants).
    /// Finishes all frames.
    [[nodiscard]] core::Result<InstantChoice>
    findInstants(const scene::World& world, const PictureRequest& request);

    /// Draws a picture and waits for it; none may be unfinished (CHECKed).
    /// \param checkpoints truth only; other methods draw none
    [[nodiscard]] core::Result<render::FrameResult> draw(
        const scene::World& world,
        const PictureRequest& request,
        const std::function<void()>& onStep = {},
        const Checkpoints& checkpoints = {}
    );

    /// Submits all frames of a picture. Waits for older frames if the renderer has no room.
    [[nodiscard]] core::Status submit(const scene::World& world, const PictureRequest& request);

    /// Waits until at most `most` frames are unfinished.
    void finishUntil(size_t most);

    /// The oldest picture that is finished and was not taken.
    [[nodiscard]] std::optional<FinishedPicture> takeFinished();

  private:
    /// A picture that the next frame may use as history.
    struct Drawn {
        extract::ViewRequest view;
        bool hasTaa = false;
        bool hasRaster = false; ///< the method stored it
    };

    /// Effects, created on first use, and the collected results of the slot's picture.
    struct Slot {
        std::unique_ptr<motion_blur::MotionBlurPlugin> motionBlur;
        std::unique_ptr<depth_of_field::DepthOfField> depthOfField;
        std::unique_ptr<taa::Taa> taa;
        std::unique_ptr<accumulate::Accumulate> accumulate;
        std::unique_ptr<truth::Truth> truth;
        truth::TruthSettings truthSettings;
        render::FrameResult result;
        std::vector<render::WrittenImage> trace; ///< of the picture's frames so far
        uint32_t tracedFrames = 0;
        std::optional<Drawn> drawn; ///< last, where the next frame may read it
        int64_t jitteredCount = 0;  ///< of frames whose places in the pixel follow one another
        /// render::kBrightest of the last picture that is finished, where it was measured.
        std::optional<float> brightest;
    };

    /// One frame of a picture.
    struct Part {
        uint32_t done = 0;   ///< samples before it
        uint32_t count = 1;  ///< its samples
        uint32_t total = 1;  ///< of the picture
        bool isShown = true; ///< its colour and display are the picture's so far
        /// Of PictureRequest::exposureParts; null: the whole exposure.
        const extract::ExposurePart* exposure = nullptr;
        bool isFirstOfExposure = true;
        bool isLastOfExposure = true; ///< the one that the next frame reads
    };

    /// A submitted frame: what to do with it when it is finished.
    struct Label {
        uint32_t slot = 0;
        bool isFirst = true;
        bool isShown = true;
        bool isLast = true;
        bool isIntermediates = false; ///< drawn for the picture's intermediates alone
        bool isBefore = false; ///< the frame before the picture's, drawn for the effect's history
        size_t exposureParts = 0; ///< of the picture
    };

    /// Sets the method's samples.
    [[nodiscard]] core::Status prepareInstants(const scene::World& world, PictureRequest& request);
    [[nodiscard]] core::Result<PictureRequest>
    prepare(const scene::World& world, const PictureRequest& request);
    /// In what parts the method takes the view's exposure.
    [[nodiscard]] std::vector<extract::ExposurePart> planExposure(
        const scene::World& world, const MethodOptions& method, const extract::ViewRequest& view
    ) const;
    [[nodiscard]] std::vector<uint32_t>
    planParts(const PictureRequest& request, const std::vector<uint32_t>& stops) const;
    [[nodiscard]] core::Status
    submitPart(const scene::World& world, const PictureRequest& request, const Part& part);
    /// Draws the whole exposure, or a part of it.
    [[nodiscard]] core::Status
    submitOwnFrame(const scene::World& world, const PictureRequest& request, const Part& part);
    [[nodiscard]] core::Status
    submitFramesBefore(const scene::World& world, const PictureRequest& request);
    /// \param age in frames, above 0
    [[nodiscard]] core::Status
    submitFrameBefore(const scene::World& world, const PictureRequest& request, uint32_t age);
    [[nodiscard]] core::Status
    submitIntermediates(const scene::World& world, const PictureRequest& request);
    [[nodiscard]] core::Status submitFrame(
        const scene::World& world,
        const render::FrameRequest& frame,
        const std::vector<render::Effect*>& effects,
        const Label& label
    );
    /// The view of one of the picture's frames, where its samples lie in the pixel.
    [[nodiscard]] extract::ViewRequest
    placeInPixel(const PictureRequest& request, const Part& part);
    /// Null: the method has none.
    [[nodiscard]] render::Effect* prepareEffect(const PictureRequest& request, const Part& part);
    /// Null: the method has no filter of the lens, or the camera has no lens.
    [[nodiscard]] render::Effect* prepareLensFilter(const PictureRequest& request);
    /// The method's own effect and its filter of the lens, in their order.
    [[nodiscard]] std::vector<render::Effect*>
    prepareBlurs(const PictureRequest& request, const Part& part);
    /// Null: the picture is no raster image.
    [[nodiscard]] render::Effect* prepareTaa(const PictureRequest& request);
    /// All that make the picture, before its ending.
    [[nodiscard]] std::vector<render::Effect*>
    prepareEffects(const PictureRequest& request, const Part& part);
    [[nodiscard]] core::Result<render::FrameResult> drawTruth(
        const scene::World& world,
        const PictureRequest& request,
        const std::function<void()>& onStep,
        const Checkpoints& checkpoints
    );
    [[nodiscard]] bool isGoodEnough(const PictureRequest& request, uint32_t rays) const;
    [[nodiscard]] render::FrameResult takeOnly();
    /// Adds the explanation that the picture's exposure was drawn in parts.
    static void explainParts(render::FrameStatistics& statistics, size_t parts);
    /// Appends a frame's trace to the picture's.
    static void keepTrace(Slot& slot, std::vector<render::WrittenImage> written);
    void finishOldest();

    gpu::Device& mDevice;
    render::Renderer& mRenderer;
    render::MotionMeasures mMeasures;
    PictureFeatures mFeatures;
    std::array<Slot, kSlots> mSlots;
    std::deque<Label> mLabels; ///< of the renderer's unfinished frames
    std::deque<FinishedPicture> mFinished;
};

} // namespace shutter::game
