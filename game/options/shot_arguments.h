// SPDX-License-Identifier: MIT
// Command-line options of a shot: scene, time, camera, lighting and display.
#pragma once

#include "engine/core/frame_rate.h"
#include "engine/core/result.h"
#include "game/options/option_rows.h"
#include "game/options/shutter_options.h"
#include "game/shot/shot_options.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace shutter::game {

struct ShotArguments {
    std::string scene;
    bool allowOutside = false;
    std::string camera;
    std::optional<double> framingTime; ///< seconds; else that of the first frame drawn
    double time = 0.0;
    std::string frames;
    std::string flythrough;
    std::optional<core::FrameRate> fps; ///< else the flythrough's, or 24
    std::vector<std::string> clips;
    bool loop = false;
    ShutterArguments shutter;
    scene::CameraLens lens{}; ///< its options count if they were typed
    std::string focusEntity;  ///< name of a node; empty: the focus is the camera's
    extract::PixelModel pixel = extract::PixelModel::Centre;
    uint32_t seed = 0;
    PictureSize size{1280, 720};
    bool unlit = false;
    math::vec3 background{0.18f};
    math::vec3 ambient{0.25f};
    std::string environment; ///< file; empty: none
    environment::EnvironmentSettings surroundings{};
    std::optional<double> sky; ///< turbidity; 0: no sky, not even a demo's own
    PictureSettings picture{};
    std::set<std::string> typed; ///< options of `lens`, `surroundings` and `picture`
};

/// Defines the scene and picture options of every command that draws a scene.
/// \param defaults of `arguments.picture`, in the help; empty: its values
void defineSceneOptions(
    CLI::App& command, ShotArguments& arguments, const std::string& defaults = {}
);
/// When a picture is taken, and of which pixels: --time, the shutter's options, --pixel, --unlit.
void defineShotOptions(CLI::App& command, ShotArguments& arguments);
/// --fstop, --focus, --focus-entity.
void defineLensOptions(CLI::App& command, ShotArguments& arguments);
/// --size.
void defineSizeOption(CLI::App& command, ShotArguments& arguments);
/// --flythrough.
void defineFlythroughOption(CLI::App& command, ShotArguments& arguments);
/// --frames, which excludes --time as --flythrough does. To be called after these are defined.
void defineFrameOptions(CLI::App& command, ShotArguments& arguments);

/// Checks everything that needs no file. The flythrough is named but not read:
/// loadFlythrough(). Error: names the option that was used wrongly.
[[nodiscard]] core::Result<ShotOptions> interpret(const ShotArguments& arguments);

/// Reads the file that `arguments.flythrough` names and plans its frames, unless --frames did; the
/// file's frame rate counts unless --fps was typed, and its shutters unless the exposure was.
/// Does nothing if there is no flythrough or if it is a clip. Error: names the file and the field.
[[nodiscard]] core::Status loadFlythrough(const ShotArguments& arguments, ShotOptions& options);

/// All values that pictures depend on, in one line. The scene and the flythrough are not among
/// them, nor which frames are drawn.
[[nodiscard]] std::string describe(const ShotArguments& arguments);

} // namespace shutter::game
