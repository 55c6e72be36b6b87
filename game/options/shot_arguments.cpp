// SPDX-License-Identifier: MIT
#include "game/options/shot_arguments.h"

#include "engine/io/file_bytes.h"
#include "engine/scene/lens.h"
#include "engine/scene/shutter.h"
#include "game/options/option_rows.h"
#include "game/shot/shot.h"

#include <array>
#include <cmath>
#include <regex>

namespace shutter::game {

namespace {

using core::makeError;
using core::Status;

constexpr std::string_view kPixelWords[] = {"centre", "box"};

using A = ShotArguments;

constexpr std::array kSceneRows = {
    makeRow<&A::allowOutside>(
        "--allow-outside",
        "allow the scene to read, and a script to write, files outside its folder",
        Matters::ToNoPicture // files count by their contents
    ),
    makeRow<&A::camera>(
        "--camera", "camera by name or index; default: the first, or one that frames the scene"
    ),
    makeRow<&A::fps>(
        "--fps",
        "frames per second, a number or a fraction such as 24000/1001; default 24, or the "
        "flythrough's; of `play` without a clock 30"
    ),
    makeRow<&A::clips>(
        "--clip",
        "clip to play, by name or index (repeatable), or none; default: all but those that move "
        "what a later one moves"
    ),
    makeRow<&A::loop>(
        "--loop,!--no-loop",
        "restart clips when they end, as `play` does; default of the others: hold the last pose"
    ),
    makeRow<&A::background>(
        "--background", "linear R,G,B where nothing is hit; default 0.18,0.18,0.18"
    ),
    makeRow<&A::ambient>("--ambient", "uniform light, R,G,B; default 0.25,0.25,0.25"),
    makeRow<&A::environment>(
        "--environment",
        "picture of all directions (.hdr, .exr, equirectangular): the background, and what lights "
        "the scene, in place of --background and --ambient",
        Matters::ToNoPicture // the file counts by its contents
    ),
    makeRow<&A::sky>(
        "--sky",
        "a clear sky of this turbidity, 1.7 (mountain air) to 10 (haze), whose sun is the scene's; "
        "0: none, not even a demo's own; default: none, or the demo's"
    ),
};

constexpr std::array kShotRows = {
    makeRow<&A::framingTime>(
        "--framing-time",
        "when a camera made to fit the scene fits it, seconds; default: in the first frame drawn",
        Matters::ToNoPicture // it counts as it is resolved, and only where a camera is made
    ),
    makeRow<&A::time>("--time", "time of the picture, seconds; default 0"),
    makeWordRow<&A::pixel, kPixelWords>("--pixel", "pixel filter: centre (default) or box"),
    makeRow<&A::seed>(
        "--seed", "seed of the sample times (truth) and of the positions of --pixel box"
    ),
    makeRow<&A::unlit>("--unlit", "draw base colour only"),
};

constexpr auto kSizeRow = makeRow<&A::size>(
    "--size", "size of the picture or the window, WxH; default 1280x720, of `play` 960x540"
);

constexpr auto kFocusEntityRow = makeRow<&A::focusEntity>(
    "--focus-entity",
    "node of the scene, by name, on which the camera focuses in place of its own focus"
);

constexpr auto kFlythroughRow = makeRow<&A::flythrough>(
    "--flythrough",
    "fly the camera along FILE.json or the scene's clip:NAME|INDEX; default: all of its frames",
    Matters::ToNoPicture
);

constexpr auto kFramesRow = makeRow<&A::frames>(
    "--frames",
    "frames A to B, as A:B; a frame's time is its number divided by --fps",
    Matters::ToNoPicture
);

Status parseTimes(const ShotArguments& arguments, ShotOptions& options) {
    // Written so that NaN fails.
    if (!(std::abs(arguments.time) <= kMaxSeconds))
        return makeError(
            "--time {} must lie in [-{}, {}]", arguments.time, kMaxSeconds, kMaxSeconds
        );
    if (arguments.framingTime && !(std::abs(*arguments.framingTime) <= kMaxSeconds))
        return makeError(
            "--framing-time {} must lie in [-{}, {}]",
            *arguments.framingTime,
            kMaxSeconds,
            kMaxSeconds
        );
    options.framingSeconds = arguments.framingTime;
    options.fps = arguments.fps.value_or(options.fps);
    options.frameSeconds = options.fps.secondsOf(1.0);
    if (arguments.frames.empty() && !arguments.flythrough.empty()) {
        options.isSequence = true; // planned when it is read
        return {};
    }
    if (arguments.frames.empty()) {
        options.frameTimes = {arguments.time};
        return {};
    }
    static const std::regex kPattern("(-?[0-9]{1,7}):(-?[0-9]{1,7})");
    std::smatch match;
    if (!std::regex_match(arguments.frames, match, kPattern))
        return makeError("--frames '{}' is not A:B, e.g. 0:23", arguments.frames);
    const int first = std::stoi(match[1]);
    const int last = std::stoi(match[2]);
    if (last < first)
        return makeError("--frames {}: the last comes before the first", match.str());
    options.isSequence = true;
    return planFrames("--frames", first, last, options);
}

Status parseSurroundings(const ShotArguments& arguments, ShotOptions& options) {
    options.environment = arguments.environment;
    options.surroundings = arguments.surroundings;
    options.turbidity = arguments.sky.value_or(0.0);
    // Written so that NaN fails.
    if (options.turbidity != 0.0 && !(options.turbidity >= environment::kMinTurbidity &&
                                      options.turbidity <= environment::kMaxTurbidity))
        return makeError(
            "--sky {} must lie in [{}, {}], or be 0",
            options.turbidity,
            environment::kMinTurbidity,
            environment::kMaxTurbidity
        );
    if (options.turbidity != 0.0 && !arguments.environment.empty())
        return makeError("--sky and --environment exclude each other");
    return {};
}

Status parseFlythrough(const ShotArguments& arguments, ShotOptions& options) {
    constexpr std::string_view kClip = "clip:";
    if (arguments.flythrough.starts_with(kClip)) {
        options.flythroughClip = arguments.flythrough.substr(kClip.size());
        if (options.flythroughClip.empty())
            return makeError("--flythrough clip: gives no name or index of a clip");
        return {};
    }
    if (!arguments.flythrough.empty() && !arguments.camera.empty())
        return makeError("--camera and --flythrough FILE exclude each other: the file is the camera"
        );
    const ShutterArguments& shutter = arguments.shutter;
    options.isFlythroughShutter = !shutter.isTyped("--exposure") &&
                                  !shutter.isTyped("--shutter-angle") &&
                                  !shutter.isTyped("--shutter-mode");
    return {};
}

Status parseLens(const ShotArguments& arguments, ShotOptions& options) {
    const char* option = arguments.typed.contains("--fstop") ? "--fstop: " : "--focus: ";
    SHUTTER_TRY(scene::validate(arguments.lens, option));
    if (arguments.typed.contains("--fstop"))
        options.fStop = arguments.lens.fStop;
    if (arguments.typed.contains("--focus"))
        options.focusDistance = arguments.lens.focusDistance;
    options.focusEntity = arguments.focusEntity;
    return {};
}

} // namespace

void defineSceneOptions(CLI::App& command, ShotArguments& arguments, const std::string& defaults) {
    defineRows(command, OptionRows<A>(kSceneRows), arguments);
    defineSettingOptions(
        command, environment::listEnvironmentRows(), arguments.surroundings, arguments.typed
    );
    visitPictureRows([&](auto rows, const auto& part) {
        defineSettingOptions(command, rows, part(arguments.picture), arguments.typed, defaults);
    });
}

void defineShotOptions(CLI::App& command, ShotArguments& arguments) {
    defineRows(command, OptionRows<A>(kShotRows), arguments);
    defineShutterOptions(command, arguments.shutter);
}

void defineLensOptions(CLI::App& command, ShotArguments& arguments) {
    defineSettingOptions(
        command, scene::listLensRows(), arguments.lens, arguments.typed, "the camera's"
    );
    kFocusEntityRow.define(command, kFocusEntityRow, arguments);
    command.get_option("--focus-entity")->excludes(command.get_option("--focus"));
}

void defineSizeOption(CLI::App& command, ShotArguments& arguments) {
    kSizeRow.define(command, kSizeRow, arguments);
}

void defineFlythroughOption(CLI::App& command, ShotArguments& arguments) {
    kFlythroughRow.define(command, kFlythroughRow, arguments);
}

void defineFrameOptions(CLI::App& command, ShotArguments& arguments) {
    kFramesRow.define(command, kFramesRow, arguments);
    for (const char* option : {"--frames", "--flythrough"})
        command.get_option(option)->excludes(command.get_option("--time"));
}

core::Result<ShotOptions> interpret(const ShotArguments& arguments) {
    ShotOptions options;
    options.scene = arguments.scene;
    options.reach = arguments.allowOutside ? io::Reach::Anywhere : io::Reach::Folder;
    options.camera = arguments.camera;
    options.clips = arguments.clips;
    options.loop = arguments.loop;
    options.pixel = arguments.pixel;
    options.seed = arguments.seed;
    options.unlit = arguments.unlit;
    options.width = arguments.size.width;
    options.height = arguments.size.height;
    options.background = arguments.background;
    options.ambient = arguments.ambient;
    for (const auto step : {parseTimes, parseSurroundings, parseFlythrough, parseLens})
        SHUTTER_TRY(step(arguments, options));
    auto shutter = interpretShutter(arguments.shutter);
    if (!shutter)
        return shutter.error();
    options.shutter = std::move(shutter).value();
    SHUTTER_TRY(validate(arguments.picture)); // which a caller may have filled in
    options.picture = arguments.picture;
    // Unlit pictures show the materials' own colours.
    if (arguments.unlit)
        options.picture.tonemap.op = tonemap::Operator::None;
    return options;
}

Status loadFlythrough(const ShotArguments& arguments, ShotOptions& options) {
    if (arguments.flythrough.empty() || !options.flythroughClip.empty())
        return {};
    auto read = flythrough::readFlythrough(arguments.flythrough);
    if (!read)
        return makeError("--flythrough: {}", read.error().message);
    auto hash = io::computeFileHash(arguments.flythrough);
    if (!hash)
        return makeError("--flythrough: {}", hash.error().message);
    options.flythroughHash = hash.value();
    options.flythrough = std::move(read).value();
    const flythrough::Flythrough& flight = *options.flythrough;
    if (!arguments.fps) {
        options.fps = flight.fps;
        options.frameSeconds = options.fps.secondsOf(1.0);
    }
    if (!arguments.frames.empty()) {
        const int first = options.firstFrame;
        return planFrames(
            "--frames", first, first + double(options.frameTimes.size()) - 1.0, options
        );
    }
    return planWholeFlight(flight.keys.front().seconds, flight.keys.back().seconds, options);
}

std::string describe(const ShotArguments& arguments) {
    std::string text = describeRows(OptionRows<A>(kSceneRows), arguments);
    text += describeRows(OptionRows<A>(kShotRows), arguments);
    for (const auto* row : {&kSizeRow, &kFocusEntityRow})
        text += describeRows(OptionRows<A>(std::span(row, 1)), arguments);
    text += core::describeValues(environment::listEnvironmentRows(), arguments.surroundings) + " ";
    text += describe(arguments.picture);
    // Interprets the options together; wrong ones are refused before a picture is drawn.
    const auto shutter = interpretShutter(arguments.shutter);
    for (const core::SettingRow<scene::CameraLens>& row : scene::listLensRows())
        if (arguments.typed.contains(row.option))
            text += fmt::format("{}={} ", row.name, core::describeValue(row, arguments.lens));
    return text + scene::describe(shutter ? shutter.value() : arguments.shutter.shutter);
}

} // namespace shutter::game
