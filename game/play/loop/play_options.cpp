// SPDX-License-Identifier: MIT
#include "game/play/loop/play_options.h"

#include "engine/io/image_file.h"
#include "game/demos/demo.h"
#include "game/options/option_rows.h"
#include "game/options/program.h"
#include "game/play/panel/play_settings.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

namespace shutter::game {

namespace {

using core::makeError;

constexpr const char* kFirstDemo = "rally";
constexpr uint32_t kMaxFrames = 1'000'000;
constexpr double kDefaultFps = 30.0;

constexpr auto kVsyncRow = makeRow<&PlayArguments::vsync>(
    "--vsync", "wait for the display: on or off; default: as in the settings"
);

bool isDemo(const std::string& name) {
    const auto demos = listDemos();
    return std::any_of(demos.begin(), demos.end(), [&](const DemoInfo& demo) {
        return name == demo.name;
    });
}

std::string listDemoNames() {
    std::string names;
    for (const DemoInfo& demo : listDemos())
        names += fmt::format("{}{}", names.empty() ? "" : ", ", demo.name);
    return names;
}

core::Status interpretFilm(const PlayArguments& arguments, PlayOptions& options) {
    options.film = arguments.film;
    if (options.film.empty())
        return {};
    if (io::lowerExtension(options.film) == ".mp4")
        return {};
    auto isDisplay = io::isDisplayFormat(options.film, ".png, .jpg or .mp4");
    if (!isDisplay)
        return makeError("--film: {}", isDisplay.error().message);
    if (!isDisplay.value())
        return makeError("--film '{}': a window's picture is no linear light", arguments.film);
    if (frameFile(options.film, 0) == frameFile(options.film, 1))
        return makeError(
            "--film '{}' needs a frame number such as %04d in the file's own name", arguments.film
        );
    return {};
}

} // namespace

void definePlayOptions(CLI::App& command, PlayArguments& a) {
    command.add_option(
        "scene", a.shot.scene, "a demo (" + listDemoNames() + ") or a glTF scene; default: rally"
    );
    defineSceneOptions(command, a.shot, "as in the settings");
    defineSizeOption(command, a.shot);
    defineFlythroughOption(command, a.shot);
    defineLensOptions(command, a.shot);
    command.add_option(
        "--method", a.method, "method, see `shutter info --methods`; default: the settings' method"
    );
    command
        .add_option("--preset", a.preset, "start with off, performance, balanced, quality or paper")
        ->excludes("--method");
    kVsyncRow.define(command, kVsyncRow, a);
    command.add_option("--ui-scale", a.uiScale, "size of text and panel, 0.5 to 4; default: 1");
    command.add_option("--settings", a.settings, "settings file (JSON); default: the player's own");
    command.add_option("--script", a.script, "play unattended from a JSON file of input");
    command.add_option(
        "--film",
        a.film,
        "write every picture without the head-up display: .png or .jpg with %04d, or .mp4"
    );
    command.add_flag(
        "--film-hud", a.filmsHud, "the film shows the head-up display and the panel, too"
    );
    command.add_option("--ffmpeg", a.ffmpeg, "program that encodes .mp4; default: the one on PATH");
    command.add_option("--frames", a.frames, "end after this many frames")
        ->check(CLI::Range(1u, kMaxFrames));
    command.add_option(
        "--stats", a.stats, "write frame times, score and more to a JSON file at the end"
    );
    command.add_option("--assets", a.assets, "folder of the demos' scenes");
    command.add_flag(
        "--no-window", a.noWindow, "draw without a display; needs --script or --frames"
    );
    defineDeviceOptions(command, a.device);
}

core::Status checkStage(const PlayOptions& options) {
    std::error_code ignored;
    if (!options.demo.empty() || std::filesystem::exists(options.shot.scene, ignored))
        return {};
    return makeError(
        "'{}' is neither a demo ({}) nor a file", options.shot.scene.string(), listDemoNames()
    );
}

core::Result<PlayOptions> interpret(const PlayArguments& arguments) {
    PlayOptions options;
    const ShotArguments& shot = arguments.shot;
    if (shot.scene.empty() || isDemo(shot.scene))
        options.demo = shot.scene.empty() ? kFirstDemo : shot.scene;
    auto interpreted = interpret(shot);
    if (!interpreted)
        return interpreted.error();
    options.shot = std::move(interpreted).value();
    if (!options.demo.empty() &&
        (!shot.camera.empty() || !shot.clips.empty() || !shot.flythrough.empty()))
        return makeError(
            "--camera, --flythrough and --clip belong to a scene, {} is a demo", options.demo
        );
    // Settings of the session, for any active camera.
    options.fStop = std::exchange(options.shot.fStop, std::nullopt);
    options.focusDistance = std::exchange(options.shot.focusDistance, std::nullopt);
    SHUTTER_TRY(loadFlythrough(shot, options.shot));
    options.fps = shot.fps.value_or(kDefaultFps);
    options.device = arguments.device;
    options.ffmpeg = arguments.ffmpeg;
    if (arguments.filmsHud && arguments.film.empty())
        return makeError("--film-hud changes nothing without --film");
    options.filmsHud = arguments.filmsHud;
    if (!arguments.method.empty()) {
        if (const auto method = findMethod(arguments.method); !method)
            return method.error();
        options.method = arguments.method;
    }
    if (!arguments.preset.empty()) {
        const auto preset = findPreset(arguments.preset);
        if (!preset)
            return preset.error();
        options.preset = preset.value();
    }
    options.vsync = arguments.vsync;
    if (const auto& scale = arguments.uiScale) {
        const auto& range = core::getRow(listPlayRows(), "uiScale").range;
        if (!core::contains(range, *scale))
            return makeError("--ui-scale {}: must be {}", *scale, core::describeRange(range, ""));
    }
    options.uiScale = arguments.uiScale;
    options.typed = shot.typed;
    if (shot.sky || !shot.environment.empty())
        options.environment = options.shot.turbidity != 0.0 || !shot.environment.empty();
    SHUTTER_TRY(interpretFilm(arguments, options));
    options.script = arguments.script;
    options.settings = arguments.settings;
    options.assets =
        arguments.assets.empty() ? findAssetFolder() : std::filesystem::path(arguments.assets);
    options.stats = arguments.stats;
    options.hasWindow = !arguments.noWindow;
    options.frames = arguments.frames;
    if (!options.hasWindow && options.script.empty() && options.frames == 0)
        return makeError("--no-window requires --script or --frames");
    return options;
}

} // namespace shutter::game
