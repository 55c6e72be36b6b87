// SPDX-License-Identifier: MIT
// Keys that change the view rather than the game.
#pragma once

#include "engine/app/input.h"
#include "game/play/panel/panel.h"
#include "game/play/panel/play_settings.h"

#include <span>
#include <string>
#include <vector>

namespace shutter::game {

/// What there is to go through.
struct Choices {
    std::span<const std::string> methods; ///< that the device can run; one at least
    std::span<const std::string> views;
};

/// The element after (`step` 1) or before (-1) `current`, round at the ends; the first where it is
/// none of them. \param choices one at least
[[nodiscard]] const std::string&
cycle(std::span<const std::string> choices, const std::string& current, int step);

/// Slower and faster speeds of the game, 0.05 to 1.
[[nodiscard]] double nextSpeed(double speed, int step);

/// Applies the keys to the settings; returns the rest as requests.
/// \param speed of the game now
[[nodiscard]] PanelRequests applyHotkeys(
    const app::InputState& input, const Choices& choices, double speed, PlaySettings& settings
);

/// What decides whether a key changes anything.
struct KeyFacts {
    std::string photoMethod;    ///< that draws photo mode's picture; empty: photo mode is off
    bool stageRests = false;    ///< the stage reads keys in steps of its time, which is paused
    bool isCameraFixed = false; ///< the scene moves the camera, not the player
    /// EffectSwitch::explainIdle() of each of listEffectSwitches().
    std::vector<std::string> idleEffects;
    double speed = 1.0; ///< of the game, before the keys
};

/// Why a pressed key changes nothing that is on the screen, in a sentence for the player; empty:
/// each does. \param settings after applyHotkeys()
[[nodiscard]] std::string
explainIdleKeys(const app::InputState& input, const KeyFacts& facts, const PlaySettings& settings);

/// Seconds for which the keys are shown yet, after a turn of `wallSeconds`. They count from the
/// first picture, and a turn that takes long for a quarter of a second at most: nobody reads while
/// the picture is frozen.
[[nodiscard]] double countHintDown(double seconds, double wallSeconds, bool hasPicture);

} // namespace shutter::game
