// SPDX-License-Identifier: MIT
// One session: input, simulation, picture, until the player has enough.
#pragma once

#include "engine/app/input_script.h"
#include "engine/app/step_clock.h"
#include "engine/app/ui.h"
#include "engine/app/window.h"
#include "engine/gpu/swapchain.h"
#include "game/play/loop/film_writer.h"
#include "game/play/loop/flythrough_recorder.h"
#include "game/play/loop/hotkeys.h"
#include "game/play/loop/play_options.h"
#include "game/play/loop/play_record.h"
#include "game/play/loop/play_renderer.h"
#include "game/play/loop/stage.h"
#include "game/play/panel/panel.h"

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace shutter::game {

class PlayLoop {
  public:
    /// Opens what is asked for: settings, script, window, device, stage.
    [[nodiscard]] static core::Result<std::unique_ptr<PlayLoop>> open(const PlayOptions& options);
    ~PlayLoop();
    PlayLoop(const PlayLoop&) = delete;
    PlayLoop& operator=(const PlayLoop&) = delete;

    /// Until it ends. Error: something failed on the way, or validation had messages.
    [[nodiscard]] core::Status run();

  private:
    using Clock = std::chrono::steady_clock;

    explicit PlayLoop(const PlayOptions& options);
    core::Status openSettings();
    core::Status openDevice();
    core::Status openStage();
    core::Status openFilm();

    /// One turn of the loop.
    core::Status advance();
    /// Wall seconds since the turn before; a script's own.
    double measureFrame();
    void applyScript();
    void applyWindowAction(app::WindowAction action);
    /// What is left for the stage of the player's input.
    app::InputState filterInput(const app::InputState& input);
    void dragDivider(const app::InputState& input);
    void drawPanel(const app::InputState& input, double wallSeconds, PanelWishes& wishes);
    void grant(const PanelWishes& wishes);
    core::Status drawPicture(double duration);
    core::Status takePictures();
    /// False where the window has no area to draw on now.
    bool fitSwapchain(const math::uvec2& size);
    [[nodiscard]] math::uvec2 windowSize() const;
    void loadSettings();
    void saveSettings();
    void refuseSettings(const std::string& why);
    void releaseDrawing();
    [[nodiscard]] app::InputCollector& collector();
    void toggleRecording();
    core::Status finish();
    /// Of the time now, for a frame that takes `duration` of game time.
    void chooseExposure(double duration);
    core::Status writePicture(const image::Image& picture);
    void replaceMissingMethods();

    const PlayOptions& mOptions;
    Clock::time_point mStart;
    PlaySettings mSettings;
    std::filesystem::path mSettingsFile; ///< empty: nowhere to keep them
    std::optional<app::ScriptPlayer> mScript;
    std::unique_ptr<app::Window> mWindow;
    app::InputCollector mInput; ///< a script's, and without a window
    std::unique_ptr<gpu::Device> mDevice;
    std::unique_ptr<gpu::Swapchain> mSwapchain;
    std::unique_ptr<Stage> mStage;
    std::unique_ptr<PlayRenderer> mRenderer;
    std::unique_ptr<app::Ui> mUi;
    Panel mPanel;
    app::StepClock mClock{kDemoStepSeconds};
    std::vector<std::string> mMethods; ///< that the device can run
    std::vector<std::string> mViews;
    std::string mMessage;
    math::uvec2 mHeadlessSize{1u};
    std::deque<std::filesystem::path> mWantedFiles;  ///< of pictures that are read back, in order
    std::vector<std::filesystem::path> mScreenshots; ///< of the next picture
    app::FrameTime mTime;
    scene::ExposureInterval mExposure;
    std::optional<Clock::time_point> mLastTurn;
    PlayRecord mRecord;
    FlythroughRecorder mRecorder;
    std::unique_ptr<FilmWriter> mFilm;
    bool mDraggingDivider = false;
    bool mHasDrawn = false;        ///< in the last turn
    bool mSettingsRefused = false; ///< the file is there and wrong
    bool mQuit = false;
};

} // namespace shutter::game
