// SPDX-License-Identifier: MIT
// A game or viewed scene: a world, the active camera, and the effect of controls on both.
#pragma once

#include "engine/app/input.h"
#include "engine/app/step_clock.h"
#include "engine/core/result.h"
#include "game/demos/demo.h"
#include "game/play/panel/panel.h"
#include "game/shot/shot_options.h"

#include <memory>
#include <string>
#include <vector>

namespace shutter::game {

/// One frame of a stage.
struct StageFrame {
    app::FrameTime time;
    double wallSeconds = 0.0; ///< since the frame before
    double heightPx = 1.0;    ///< of the window, above 0
    bool paused = false;
};

class Stage {
  public:
    virtual ~Stage() = default;

    [[nodiscard]] virtual std::string title() const = 0;
    [[nodiscard]] virtual scene::World& world() = 0;
    [[nodiscard]] virtual ecs::Entity camera() const = 0;
    [[nodiscard]] virtual DemoAppearance appearance() const = 0;
    /// Moves on by a frame, as the player wants.
    virtual void advance(const app::InputState& input, const StageFrame& frame) = 0;

    /// Applies the stage's own settings of its camera's shutter at the time.
    virtual void adjustShutter(double seconds, scene::CameraShutter& shutter) const {
        (void)seconds;
        (void)shutter;
    }

    /// Whether the camera is in the player's hand, while the game is paused, too.
    [[nodiscard]] virtual bool holdsCamera() const { return false; }

    /// Whether keys act in steps of its time, and so not while the game is paused.
    [[nodiscard]] virtual bool readsKeysInSteps() const { return false; }

    /// Where its time starts, seconds.
    [[nodiscard]] virtual double startSeconds() const { return 0.0; }

    /// Lines for the head-up display.
    [[nodiscard]] virtual std::vector<HudLine> hud() const = 0;

    /// The keys that the stage itself reads.
    [[nodiscard]] virtual std::vector<KeyHelp> keys() const { return {}; }

    /// True at the end of a game.
    [[nodiscard]] virtual bool isOver() const { return false; }

    /// The score of a game; only games have one.
    [[nodiscard]] virtual std::optional<int> score() const { return std::nullopt; }
};

/// The keys of a demo: those of the controls that have words.
[[nodiscard]] std::vector<KeyHelp> listDemoKeys(const DemoControlWords& words);

/// \param options environment and sky count, before the demo's own sky, and the node to focus on
/// Error: an environment that cannot be read, a node that the demo lacks.
[[nodiscard]] core::Result<std::unique_ptr<Stage>>
makeDemoStage(std::unique_ptr<Demo> demo, const ShotOptions& options);

/// Views a scene file: its cameras, an orbiting one and a flying one.
/// \param options scene, camera, flythrough, clips, loop, the node to focus on, background, ambient
/// and size are used
[[nodiscard]] core::Result<std::unique_ptr<Stage>> loadSceneStage(const ShotOptions& options);

} // namespace shutter::game
