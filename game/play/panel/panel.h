// SPDX-License-Identifier: MIT
// What a player sees over the picture: head-up display and panel. They show settings and statistics
// and return changed settings and requests.
#pragma once

#include "engine/app/ui.h"
#include "engine/render/renderer.h"
#include "game/demos/demo.h"
#include "game/play/panel/pass_history.h"
#include "game/play/panel/play_settings.h"

#include <optional>
#include <span>
#include <string>

namespace shutter::game {

/// A key and its action, in a few words.
struct KeyHelp {
    std::string key;
    std::string what;
};

/// Data of a frame for the panel.
struct PanelFacts {
    std::string title;             ///< of the demo or scene
    std::span<const HudLine> hud;  ///< of a demo
    std::span<const KeyHelp> keys; ///< of the demo or scene, besides those of every session
    bool showsHint = false;        ///< the most important keys are shown below the picture
    std::string message;           ///< one line, e.g. what could not be done; empty: none
    std::string notice;            ///< what the player waits for; empty: nothing
    /// The last finished frame's; null: none yet. Passes and work have reasons if the frame was
    /// drawn with FrameRequest::wantReasons.
    const render::FrameStatistics* right = nullptr;
    const render::FrameStatistics* left = nullptr; ///< of a split; null: no split
    double frameMilliseconds = 0.0;   ///< wall time of a frame, mean of the last second's
    math::uvec2 pictureSize{1u};      ///< pixels
    scene::ExposureInterval exposure; ///< of the frame
    bool paused = false;
    bool photo = false;                ///< photo mode is on
    std::optional<uint32_t> photoRays; ///< per pixel of its picture; nothing: none are traced
    std::string photoMethod;           ///< that draws it; empty: the settings' own
    scene::CameraLens lens;            ///< of the last picture's camera; fStop 0: a pinhole
    bool isViewMissing = false;        ///< the last picture shows no `view` although one is set
    double speed = 1.0;
    bool recording = false;               ///< a flythrough is being recorded
    std::span<const std::string> methods; ///< that the device can run
    std::span<const std::string> views;   ///< intermediates that can be shown
};

/// What the player wants, as clicked on the panel or typed.
struct PanelRequests {
    bool save = false;
    bool load = false;
    bool togglePause = false;
    bool togglePhoto = false;
    bool savePicture = false;
    bool singleStep = false;
    bool toggleRecording = false;
    bool focusMiddle = false; ///< focus on what is in the middle of the picture
    bool focusOwn = false;    ///< focus as the camera itself does
    bool toggleFullScreen = false;
    bool quit = false;
    std::optional<double> speed; ///< [1/64, 1]
};

class Panel {
  public:
    /// Declares the user interface of one frame (between Ui::begin and Ui::end). Changes
    /// `settings`, which are valid before and after.
    PanelRequests draw(const PanelFacts& facts, PlaySettings& settings);

  private:
    PassHistory mHistory; ///< of the right side
};

} // namespace shutter::game
