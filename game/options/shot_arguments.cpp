// SPDX-License-Identifier: MIT
#include "game/options/shot_arguments.h"

#include "engine/io/file_bytes.h"
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
using Row = OptionRow<A>;

constexpr std::array kViewRows = {
    makeRow<&A::camera>(
        "--camera", "camera by name or index; default: the first, or one that frames the scene"
    ),
    makeRow<&A::framingTime>(
        "--framing-time",
        "when a camera made to fit the scene fits it, seconds; default: in the first frame drawn",
        Matters::ToNoPicture // it counts as it is resolved, and only where a camera is made
    ),
    makeWordRow<&A::frameFit, kFrameFitWords>(
        "--frame-fit",
        "a camera's frame in a picture of another shape: whole (default), or height: a narrower "
        "picture crops its sides"
    ),
    makeRow<&A::time>("--time", "time of the picture, seconds; default 0"),
    makeRow<&A::fps>(
        "--fps",
        "frames per second, a number or a fraction such as 24000/1001; default 24, or the "
        "flythrough's"
    ),
    makeRow<&A::clips>(
        "--clip",
        "clip to play, by name or index (repeatable), or none; default: all but those that move "
        "what a later one moves"
    ),
    makeRow<&A::loop>("--loop", "restart clips when they end; default: hold the last pose"),
};

constexpr auto kOutsideRow = makeRow<&A::allowOutside>(
    "--allow-outside",
    "let the scene read, and a script write, files outside its folder",
    Matters::ToNoPicture // what is read counts by its contents
);

constexpr std::array kLookRows = {
    makeWordRow<&A::pixel, kPixelWords>("--pixel", "pixel filter: centre (default) or box"),
    makeRow<&A::seed>(
        "--seed", "seed of the sample times (truth) and of the positions of --pixel box"
    ),
    makeRow<&A::unlit>("--unlit", "draw base colour only"),
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
    makeRow<&A::environmentIntensity>(
        "--environment-intensity",
        "factor of the light of --environment or --sky, 0 to 1000; default 1"
    ),
    makeRow<&A::environmentRotation>(
        "--environment-rotation", "turns the environment to the left, degrees; default 0"
    ),
    makeRow<&A::sky>(
        "--sky",
        "a clear sky of this turbidity, 1.7 (mountain air) to 10 (haze), whose sun is the scene's; "
        "default 0: none"
    ),
    makeWordRow<&A::shadows, kShadowWords>(
        "--shadows",
        "shadows of lights: none (default), sharp, or blurred: what moves casts them over the "
        "exposure"
    ),
    makeRow<&A::shadowMapSize>(
        "--shadow-map-size", "width of a shadow map, texels, 64 to 8192; default 1024"
    ),
    makeRow<&A::shadowDistance>(
        "--shadow-distance",
        "how far directional lights cast shadows, metres; default 0: as far as the scene reaches"
    ),
    makeRow<&A::shadowInstants>(
        "--shadow-instants", "instants of a blurred shadow, 1 to 64; default 16"
    ),
};

constexpr std::array kTonemapRows = {
    makeRow<&A::exposureValue>("--ev", "stops of exposure before tone mapping; default 0"),
    makeWordRow<&A::tonemap, kTonemapWords>("--tonemap", "tone mapper: neutral (default) or none"),
};

constexpr std::array kFrameRows = {
    makeWordRow<&A::antiAliasing, kAntiAliasingWords>(
        "--aa",
        "smooth edges: none (default), taa (by the frames before) or box (the mean of 16 frames)"
    ),
    makeRow<&A::bloom>(
        "--bloom", "share of highlights' light that the lens scatters, 0 to 1; default 0: no bloom"
    ),
    makeRow<&A::bloomThreshold>(
        "--bloom-threshold",
        "light above which a pixel is a highlight; default 1; 0: all light is scattered"
    ),
    makeRow<&A::bloomKnee>(
        "--bloom-knee",
        "how far around the threshold highlights set in, as a share of it, 0 to 1; default 0.5"
    ),
    makeRow<&A::size>("--size", "picture size WxH; default 1280x720"),
    makeRow<&A::frames>(
        "--frames",
        "frames A to B, as A:B; a frame's time is its number divided by --fps",
        Matters::ToNoPicture
    ),
    makeRow<&A::flythrough>(
        "--flythrough",
        "fly the camera along FILE.json or the scene's clip:NAME|INDEX; default: all of its frames",
        Matters::ToNoPicture
    ),
};

Status parseBloom(const ShotArguments& arguments, ShotOptions& options) {
    // Each alone, so that the option that is out of its range is named.
    if (!bloom::validate({.share = arguments.bloom}).ok())
        return makeError("--bloom {} must lie in [0, 1]", arguments.bloom);
    if (!bloom::validate({.threshold = arguments.bloomThreshold}).ok())
        return makeError(
            "--bloom-threshold {} must lie in [0, {}]",
            arguments.bloomThreshold,
            bloom::kMostThreshold
        );
    if (!bloom::validate({.knee = arguments.bloomKnee}).ok())
        return makeError("--bloom-knee {} must lie in [0, 1]", arguments.bloomKnee);
    options.bloom = {arguments.bloom, arguments.bloomThreshold, arguments.bloomKnee};
    return {};
}

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

Status parseShadows(const ShotArguments& arguments, ShotOptions& options) {
    options.shadows = {
        .mode = arguments.shadows,
        .mapSize = arguments.shadowMapSize,
        .distance = arguments.shadowDistance,
        .instants = arguments.shadowInstants};
    // Written so that NaN fails.
    if (!(arguments.shadowDistance >= 0.0 && std::isfinite(arguments.shadowDistance)))
        return makeError(
            "--shadow-distance {} must be 0 or more and finite", arguments.shadowDistance
        );
    if (arguments.shadowInstants < 1 || arguments.shadowInstants > 64)
        return makeError("--shadow-instants {} must lie in [1, 64]", arguments.shadowInstants);
    if (!extract::validate(options.shadows).ok())
        return makeError(
            "--shadow-map-size {} must be a multiple of 64 from 64 to 8192", arguments.shadowMapSize
        );
    return {};
}

Status parseSurroundings(const ShotArguments& arguments, ShotOptions& options) {
    options.environment = arguments.environment;
    options.surroundings = {
        .intensity = arguments.environmentIntensity,
        .rotationDegrees = arguments.environmentRotation};
    options.turbidity = arguments.sky;
    // Written so that NaN fails.
    if (!(arguments.environmentIntensity >= 0.0 && arguments.environmentIntensity <= 1000.0))
        return makeError(
            "--environment-intensity {} must lie in [0, 1000]", arguments.environmentIntensity
        );
    if (!(std::abs(arguments.environmentRotation) <= 360.0))
        return makeError(
            "--environment-rotation {} must lie in [-360, 360]", arguments.environmentRotation
        );
    if (arguments.sky != 0.0 && !(arguments.sky >= environment::kLeastTurbidity &&
                                  arguments.sky <= environment::kMostTurbidity))
        return makeError(
            "--sky {} must lie in [{}, {}], or be 0",
            arguments.sky,
            environment::kLeastTurbidity,
            environment::kMostTurbidity
        );
    if (arguments.sky != 0.0 && !arguments.environment.empty())
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

} // namespace

void defineOutsideOption(CLI::App& command, ShotArguments& arguments) {
    kOutsideRow.define(command, kOutsideRow, arguments);
}

void defineShotOptions(CLI::App& command, ShotArguments& arguments) {
    defineOutsideOption(command, arguments);
    defineRows(command, OptionRows<A>(kViewRows), arguments);
    defineShutterOptions(command, arguments.shutter);
    defineRows(command, OptionRows<A>(kLookRows), arguments);
    defineTonemapOptions(command, arguments);
}

std::vector<CLI::Option*> defineTonemapOptions(CLI::App& command, ShotArguments& arguments) {
    std::vector<CLI::Option*> options;
    for (const Row& row : kTonemapRows)
        options.push_back(row.define(command, row, arguments));
    return options;
}

void defineFrameOptions(CLI::App& command, ShotArguments& arguments) {
    defineRows(command, OptionRows<A>(kFrameRows), arguments);
    for (const char* option : {"--frames", "--flythrough"})
        command.get_option(option)->excludes(command.get_option("--time"));
}

core::Result<tonemap::TonemapSettings> interpretTonemap(const ShotArguments& arguments) {
    if (!(std::abs(arguments.exposureValue) <= 32.0)) // NaN too
        return makeError("--ev must lie in [-32, 32]");
    return tonemap::TonemapSettings{
        .op = arguments.tonemap, .exposureValue = arguments.exposureValue};
}

core::Result<ShotOptions> interpret(const ShotArguments& arguments) {
    ShotOptions options;
    options.scene = arguments.scene;
    options.reach = arguments.allowOutside ? io::Reach::Anywhere : io::Reach::Folder;
    options.camera = arguments.camera;
    options.frameFit = arguments.frameFit;
    options.clips = arguments.clips;
    options.loop = arguments.loop;
    options.pixel = arguments.pixel;
    options.seed = arguments.seed;
    options.antiAliasing = arguments.antiAliasing;
    options.unlit = arguments.unlit;
    options.width = arguments.size.width;
    options.height = arguments.size.height;
    options.background = arguments.background;
    options.ambient = arguments.ambient;
    for (const auto step : {parseTimes, parseSurroundings, parseShadows, parseFlythrough})
        SHUTTER_TRY(step(arguments, options));
    auto shutter = interpretShutter(arguments.shutter);
    if (!shutter)
        return shutter.error();
    options.shutter = std::move(shutter).value();
    SHUTTER_TRY(parseBloom(arguments, options));
    auto tonemap = interpretTonemap(arguments);
    if (!tonemap)
        return tonemap.error();
    options.tonemap = tonemap.value();
    // Unlit pictures show the materials' own colours.
    if (arguments.unlit)
        options.tonemap.op = tonemap::Operator::None;
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
    std::string text;
    for (const OptionRows<A> rows :
         {OptionRows<A>(kViewRows),
          OptionRows<A>(kLookRows),
          OptionRows<A>(kTonemapRows),
          OptionRows<A>(kFrameRows)})
        text += describeRows(rows, arguments);
    // What the options mean together; wrong ones are refused before a picture is drawn.
    const auto shutter = interpretShutter(arguments.shutter);
    return text + scene::describe(shutter ? shutter.value() : arguments.shutter.shutter);
}

} // namespace shutter::game
