// SPDX-License-Identifier: MIT
// Draws what a player sees: one picture by one method, or two side by side, with as many frames in
// flight as the renderer has.
#pragma once

#include "engine/app/kept_picture.h"
#include "engine/app/window_output.h"
#include "engine/render/renderer.h"
#include "game/play/panel/play_settings.h"
#include "game/shot/picture_drawer.h"
#include "game/shot/picture_effects.h"
#include "modules/debug_view/debug_view.h"

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace shutter::game {

enum class PlaySide : uint8_t { Right, Left };

/// What one picture on the window is made of.
struct PlayPicture {
    extract::ViewRequest view;
    app::WindowTarget window;
    bool readBack = false;    ///< keep the window's picture for takePicture()
    bool wantReasons = false; ///< of the work and passes too, and counters, for the panel
    motion_blur::UntilReady untilReady = motion_blur::UntilReady::Wait;

    /// Rays that are added to the picture drawn last, whose view it shares.
    struct MoreRays {
        uint32_t before = 0; ///< per pixel of the picture so far
        uint32_t added = 0;  ///< per pixel of this frame
    };

    std::optional<MoreRays> moreRays; ///< for the method truth without a split
};

/// Each world's assets need a separate renderer.
class PlayRenderer {
  public:
    PlayRenderer(gpu::Device& device, const scene::Assets& assets);
    PlayRenderer(const PlayRenderer&) = delete;
    PlayRenderer& operator=(const PlayRenderer&) = delete;

    /// Finishes frames until one more may be submitted. To be called before each draw() and before
    /// an image of the window is acquired.
    void makeRoom(const PlaySettings& settings);

    /// Submits the frames of one picture, with a split both sides'. `method` fields must name
    /// methods that the device can run.
    [[nodiscard]] core::Status
    draw(const scene::World& world, const PlayPicture& picture, const PlaySettings& settings);

    /// Finishes all that was submitted.
    void finishAll();

    /// Statistics of the last finished picture of that side, summed over its frames; null before
    /// the first.
    [[nodiscard]] const render::FrameStatistics* statistics(PlaySide side) const;

    /// The last picture shows no view although one was requested: no effect made it.
    [[nodiscard]] bool isViewMissing() const { return mRightView.isMissing(); }

    /// The window's picture that was read back and finished first, in display encoding.
    [[nodiscard]] std::optional<image::Image> takePicture();

  private:
    [[nodiscard]] core::Result<PictureRequest> makeRequest(
        const scene::World& world,
        PlaySide side,
        const render::FrameRequest& frame,
        motion_blur::UntilReady untilReady,
        const PlaySettings& settings
    );
    /// Keeps what the finished pictures leave.
    void takeFinished();

    render::Renderer mRenderer;
    PictureEffects mEffects;
    debug_view::DebugView mLeftView;
    debug_view::DebugView mRightView;
    app::KeptPicture mKept;
    app::WindowOutput mWindow;

    /// GPU milliseconds of the last finished pictures besides their blur, of one side.
    struct OtherTimes {
        std::array<double, 5> milliseconds{};
        size_t count = 0;

        void add(const render::FrameStatistics& statistics);
        /// The median, which one frame that compiles shaders does not change; 0: there is none.
        [[nodiscard]] double find() const;
    };

    std::optional<render::FrameStatistics> mShown[2]; ///< per PlaySide
    OtherTimes mOtherTimes[2];                        ///< per PlaySide
    std::deque<image::Image> mPictures;
    PictureDrawer mDrawer; ///< the last: its unfinished frames use the effects above
};

} // namespace shutter::game
