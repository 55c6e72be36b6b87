// SPDX-License-Identifier: MIT
// Command-line options of `shutter play`, and their interpretation.
#pragma once

#include "engine/core/result.h"
#include "game/options/render_arguments.h"

#include <filesystem>
#include <optional>
#include <set>
#include <string>

namespace shutter::game {

/// As typed.
struct PlayArguments {
    PlayArguments() {
        shot.size = {960, 540};
        shot.loop = true;
    }

    ShotArguments shot; ///< scene, camera, flythrough, clips, loop, fps, size, light, lens count
    gpu::DeviceOptions device;
    std::string ffmpeg;
    std::string method; ///< empty: the settings' own
    std::string preset; ///< empty: none
    std::string script;
    std::string film;
    std::string settings;
    std::string assets;
    std::string stats;
    std::optional<bool> vsync;
    std::optional<double> uiScale;
    bool filmsHud = false;
    bool noWindow = false;
    uint32_t frames = 0;
};

/// As meant.
struct PlayOptions {
    std::string demo; ///< of listDemos(); empty: a scene is viewed
    ShotOptions shot; ///< scene, camera, clips, loop, size and light count
    gpu::DeviceOptions device;
    std::filesystem::path ffmpeg;      ///< empty: the one on PATH
    std::optional<std::string> method; ///< wins over the settings' own
    const Preset* preset = nullptr;    ///< wins over the settings' own method and effects
    std::filesystem::path script;      ///< empty: a person plays
    std::filesystem::path film;        ///< %04d.png or .mp4; empty: none
    bool filmsHud = false;             ///< its pictures show the head-up display and the panel
    core::FrameRate fps = 30.0;        ///< of frames that do not run in real time
    std::filesystem::path settings;    ///< empty: the player's own
    std::filesystem::path assets;      ///< folder of the demos' scenes
    std::filesystem::path stats;       ///< empty: none
    std::optional<bool> vsync;         ///< wins over the settings' own
    std::optional<double> uiScale;     ///< wins over the settings' own
    std::set<std::string> typed;       ///< options of shot.picture that win over the settings' own
    std::optional<bool> environment;   ///< wins over the settings' own
    std::optional<double> fStop;       ///< wins over the settings' own; 0: no depth of field
    std::optional<double> focusDistance; ///< metres; wins over the settings' own
    bool hasWindow = true;
    uint32_t frames = 0; ///< ends after as many; 0: never
};

/// Adds `shutter play`, which leaves its exit status (game/options/program.h).
void addPlayCommand(CLI::App& app, int& exitStatus);

void definePlayOptions(CLI::App& command, PlayArguments& arguments);

/// Error: the options name neither a demo nor a file. For before a window is opened.
[[nodiscard]] core::Status checkStage(const PlayOptions& options);

/// Error: names the option that was used wrongly.
[[nodiscard]] core::Result<PlayOptions> interpret(const PlayArguments& arguments);

} // namespace shutter::game
