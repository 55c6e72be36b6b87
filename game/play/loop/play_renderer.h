// SPDX-License-Identifier: MIT
// Draws what a player sees: one picture by one method, or two side by side, with as many frames in
// flight as the renderer has.
#pragma once

#include "engine/app/kept_picture.h"
#include "engine/app/window_output.h"
#include "engine/render/renderer.h"
#include "game/play/panel/play_settings.h"
#include "game/shot/methods.h"
#include "modules/accumulate/accumulate.h"
#include "modules/debug_view/debug_view.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "modules/tonemap/tonemap.h"
#include "modules/truth/truth.h"

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace shutter::game {

enum class PlaySide : uint8_t { Right, Left };

/// What one picture on the window is made of.
struct PlayPicture {
    extract::ViewRequest view;
    app::WindowTarget window;
    gpu::SubmitSemaphores semaphores; ///< of the frame that draws on the window
    bool readBack = false;            ///< keep the window's picture for takePicture()
    bool wantReasons = false;         ///< of the work and passes too, for the panel
};

/// One a world's assets.
class PlayRenderer {
  public:
    PlayRenderer(gpu::Device& device, const scene::Assets& assets);
    ~PlayRenderer();
    PlayRenderer(const PlayRenderer&) = delete;
    PlayRenderer& operator=(const PlayRenderer&) = delete;

    /// Finishes frames until one more may be submitted. To be called before each draw() and before
    /// an image of the window is asked for.
    void makeRoom(const PlaySettings& settings);

    /// Submits the frames of one picture, with a split both sides'. `method` fields must name
    /// methods that the device can run.
    [[nodiscard]] core::Status
    draw(const scene::World& world, const PlayPicture& picture, const PlaySettings& settings);

    /// Finishes all that was submitted.
    void finishAll();

    /// Of the last finished picture of that side, summed over its frames; null before the first.
    [[nodiscard]] const render::FrameStatistics* statistics(PlaySide side) const;

    /// The window's picture that was read back and finished first, in display encoding.
    [[nodiscard]] std::optional<image::Image> takePicture();

  private:
    /// What each side has of its own.
    struct SideEffects {
        std::unique_ptr<motion_blur::MotionBlurPlugin> blur; ///< these made when first used
        std::unique_ptr<accumulate::Accumulate> accumulate;
        std::unique_ptr<truth::Truth> truth;
        std::optional<render::FrameStatistics> shown;
        render::FrameStatistics sum; ///< of the picture that is being drawn
    };

    /// A submitted frame: what to do with it when it is finished.
    struct Label {
        PlaySide side = PlaySide::Right;
        bool isFirst = true; ///< of its picture
        bool isLast = true;
        bool readBack = false;
    };

    /// Frames of one side's picture, and what ends them.
    struct SidePicture {
        PlaySide side = PlaySide::Right;
        const MethodInfo* method = nullptr;
        render::FrameRequest request;
        std::vector<render::PostEffect*> ending; ///< after the method's own effect
    };

    void finishOldest();

    SideEffects& effectsOf(PlaySide side) { return mSides[static_cast<size_t>(side)]; }

    core::Status submit(
        const scene::World& world,
        const render::FrameRequest& request,
        const std::vector<render::PostEffect*>& effects,
        const Label& label
    );
    core::Status
    drawSide(const scene::World& world, SidePicture& picture, const PlaySettings& settings);
    /// One of the frames of a picture whose first effect adds them up; the last one shows it.
    core::Status submitPart(
        const scene::World& world,
        const SidePicture& picture,
        render::FrameRequest request,
        size_t index,
        size_t count
    );
    core::Status
    drawInstants(const scene::World& world, SidePicture& picture, const PlaySettings& settings);
    core::Status
    drawRays(const scene::World& world, SidePicture& picture, const PlaySettings& settings);

    gpu::Device& mDevice;
    render::Renderer mRenderer;
    tonemap::Tonemap mTonemap;
    debug_view::DebugView mLeftView;
    debug_view::DebugView mRightView;
    app::KeptPicture mKept;
    app::WindowOutput mWindow;
    SideEffects mSides[2];
    std::deque<Label> mLabels; ///< of the renderer's unfinished frames
    std::deque<image::Image> mPictures;
};

} // namespace shutter::game
