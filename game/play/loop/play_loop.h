// SPDX-License-Identifier: MIT
// One session: input, simulation, picture, until the player has enough.
#pragma once

#include "engine/app/input_script.h"
#include "engine/app/step_clock.h"
#include "engine/core/progress.h"
#include "game/play/loop/first_use.h"
#include "game/play/loop/flythrough_recorder.h"
#include "game/play/loop/hotkeys.h"
#include "game/play/loop/photo_mode.h"
#include "game/play/loop/picture_files.h"
#include "game/play/loop/play_record.h"
#include "game/play/loop/play_screen.h"
#include "game/play/loop/session_watch.h"
#include "game/play/loop/settings_keeper.h"
#include "game/play/loop/stage.h"
#include "game/play/panel/panel.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace shutter::game {

class PlayLoop {
  public:
    /// Opens what the options name: script, settings, film, window, device, stage. `options` and
    /// `watch`, which may be null, must outlive the loop.
    [[nodiscard]] static core::Result<std::unique_ptr<PlayLoop>>
    open(const PlayOptions& options, SessionWatch* watch = nullptr);
    ~PlayLoop();
    PlayLoop(const PlayLoop&) = delete;
    PlayLoop& operator=(const PlayLoop&) = delete;

    /// Until it ends. Error: something failed on the way, or validation had messages.
    [[nodiscard]] core::Status run();

  private:
    using Clock = std::chrono::steady_clock;

    PlayLoop(const PlayOptions& options, SessionWatch* watch);
    core::Status openScript();
    core::Status openScreen();
    core::Status openStage();

    /// One turn of the loop.
    core::Status advance();
    /// Seconds of wall time since the turn before; a script's and a film's own.
    double measureFrame();
    void applyScript();
    /// The player's input without what the user interface and the divider take.
    app::InputState filterInput(const app::InputState& input);
    void dragDivider(const app::InputState& input);
    /// Shows a line of text in place of a picture.
    core::Status showNotice(const std::string& text);
    /// Whether a person plays: pictures of scripts, films and watched sessions must not depend on
    /// time.
    [[nodiscard]] bool isForPlayer() const;
    PanelRequests drawPanel(const app::InputState& input, double wallSeconds);
    /// Removes a message that was shown long enough: what it states may not hold any more.
    void endMessage(double wallSeconds);
    [[nodiscard]] KeyFacts describeKeys() const;
    /// Intermediates that the methods on the screen make.
    [[nodiscard]] std::vector<std::string> listViews() const;
    /// Without the stage's part: lines, keys and views.
    [[nodiscard]] PanelFacts describeSession() const;
    void apply(const PanelRequests& requests);
    core::Status drawPicture(double duration);
    [[nodiscard]] PlayPicture makePicture(const math::uvec2& sizePx, const PlaySettings& settings);
    /// Records that a picture was submitted.
    void notePicture();
    void toggleRecording();
    /// Reports progress from now on, if this is a film that ends by itself.
    void startProgress();
    core::Status finish();
    core::Status writeRecord();
    /// Destroys the renderers before their resources.
    void releaseDrawing();
    /// Sets the exposure of a frame that ends now and takes `duration` seconds of game time.
    void chooseExposure(double duration);
    void replaceMissingMethods();
    void turnPhotoMode(bool on);
    /// Gives the camera the player's lens.
    void overrideLens();
    /// The same, and takes it to where it focuses by now.
    void prepareLens();
    /// Focuses on what was in the middle of the last picture.
    void focusOnMiddle();
    /// Focuses as the camera itself does.
    void focusAsCamera();
    /// Reports a new focus, and why none of it is seen.
    void reportFocus(const std::string& focus);
    /// Why the next picture has no depth of field; empty: it has.
    [[nodiscard]] std::string explainPinhole() const;
    /// Warns a player who named a lens that it has no effect.
    void warnOfPinhole();
    /// The active camera: photo mode's, or the stage's.
    [[nodiscard]] ecs::Entity camera() const;
    /// Requests the next picture as a file.
    void savePicture();
    /// With which the next picture is drawn.
    [[nodiscard]] PlaySettings chooseSettings() const;
    [[nodiscard]] double chooseUiScale(const app::InputState& input);

    const PlayOptions& mOptions;
    SessionWatch* mWatch; ///< null: there is no observer
    Clock::time_point mStart;
    PlaySettings mSettings;
    SettingsKeeper mKeeper;
    std::optional<app::ScriptPlayer> mScript;
    PlayScreen mScreen;
    std::unique_ptr<Stage> mStage;
    std::unique_ptr<PlayRenderer> mRenderer;
    PictureFiles mFiles;
    Panel mPanel;
    app::StepClock mClock{kDemoStepSeconds};
    std::vector<std::string> mMethods; ///< that the device can run
    std::string mMessage;
    std::string mSeenMessage;     ///< in the last turn
    double mMessageSeconds = 0.0; ///< for which it is shown yet
    app::FrameTime mTime;
    scene::ExposureInterval mExposure;
    std::optional<Clock::time_point> mLastTurn;
    std::optional<core::Progress> mProgress; ///< of a film
    PlayRecord mRecord;
    FirstUse mFirstUse;
    FlythroughRecorder mRecorder;
    PhotoMode mPhoto;
    PhotoCamera mPhotoCamera;
    double mUiScale = 1.0;     ///< that is shown: it follows the setting when no button is held
    double mHintSeconds = 0.0; ///< for which the keys are shown yet
    bool mDraggingDivider = false;
    bool mHasDrawn = false;            ///< in the last turn
    uint32_t mTurnsWithoutPicture = 0; ///< on end, of a window that is not hidden
    bool mQuit = false;
};

} // namespace shutter::game
