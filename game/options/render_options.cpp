// SPDX-License-Identifier: MIT
#include "game/options/render_options.h"

#include "engine/core/setting_row.h"
#include "engine/io/image_file.h"
#include "game/options/setting_options.h"
#include "game/options/tonemap_options.h"
#include "game/output/film.h"
#include "shaders/common/numeric.glsl"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <regex>
#include <system_error>
#include <unistd.h>

namespace shutter::game {

namespace {

using core::makeError;
using core::Result;
using core::Status;

constexpr uint32_t kMaxSize = 16384;
constexpr uint32_t kMaxSamples = 65536;
constexpr int kMaxFrames = 1000000;

bool isFilm(const std::filesystem::path& out) {
    std::string extension = out.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
        return char(std::tolower(c));
    });
    return extension == ".mp4";
}

/// Empty: query.
Result<gpu::RayTier> interpretRays(const std::string& text) {
    if (text.empty() || text == "query")
        return gpu::RayTier::RayQuery;
    if (text == "pipeline")
        return gpu::RayTier::Pipeline;
    if (text == "none")
        return gpu::RayTier::None;
    return makeError("--rays '{}' is not one of query, pipeline, none", text);
}

Result<math::vec3> parseColor(const char* option, const std::string& text) {
    const auto parts = splitAt(text, ',');
    math::vec3 color(0.0f);
    if (parts.size() != 3)
        return makeError("{} '{}' is not R,G,B", option, text);
    for (int i = 0; i < 3; ++i) {
        const auto value = core::parseNumber(parts[static_cast<size_t>(i)]);
        if (!value || *value < 0.0 || *value > double(shader::kMaxColor))
            return makeError(
                "{} '{}' is not R,G,B of numbers in [0, {}]", option, text, shader::kMaxColor
            );
        color[i] = static_cast<float>(*value);
    }
    return color;
}

Status parseSize(const std::string& text, RenderOptions& options) {
    static const std::regex kPattern("([0-9]{1,6})x([0-9]{1,6})");
    std::smatch match;
    if (!std::regex_match(text, match, kPattern))
        return makeError("--size '{}' is not WxH, e.g. 1280x720", text);
    options.width = static_cast<uint32_t>(std::stoul(match[1]));
    options.height = static_cast<uint32_t>(std::stoul(match[2]));
    if (options.width < 1 || options.height < 1 || options.width > kMaxSize ||
        options.height > kMaxSize)
        return makeError("--size {} must lie between 1x1 and {}x{}", text, kMaxSize, kMaxSize);
    return {};
}

Status parseTimes(const RenderArguments& arguments, RenderOptions& options) {
    // Written so that NaN fails.
    if (!(std::abs(arguments.time) <= kMaxSeconds))
        return makeError(
            "--time {} must lie in [-{}, {}]", arguments.time, kMaxSeconds, kMaxSeconds
        );
    if (!(arguments.fps > 0.0) || !std::isfinite(arguments.fps))
        return makeError("--fps {} must be above 0", arguments.fps);
    options.fps = arguments.fps;
    options.frameSeconds = 1.0 / options.fps;
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

Status parseFlythrough(const RenderArguments& arguments, RenderOptions& options) {
    constexpr std::string_view kClip = "clip:";
    if (arguments.flythrough.starts_with(kClip)) {
        options.flythroughClip = arguments.flythrough.substr(kClip.size());
        return {};
    }
    if (!arguments.flythrough.empty() && !arguments.camera.empty())
        return makeError("--camera and --flythrough FILE exclude each other: the file is the camera"
        );
    options.isFlythroughShutter =
        !arguments.exposureSeconds && !arguments.shutterAngle && arguments.shutterMode.empty();
    return {};
}

Status parseShutter(const RenderArguments& arguments, RenderOptions& options) {
    auto shutter = interpretShutter(arguments, options.frameSeconds);
    if (!shutter)
        return shutter.error();
    options.shutter = std::move(shutter).value();
    return {};
}

Status parseMethod(const RenderArguments& arguments, RenderOptions& options) {
    auto method = findMethod(arguments.method);
    if (!method)
        return method.error();
    options.method = method.value();
    if (arguments.samples > kMaxSamples)
        return makeError("--samples {} is above {}", arguments.samples, kMaxSamples);
    options.samples = arguments.samples > 0 ? arguments.samples : options.method->defaultSamples;
    if (options.method->family == MethodFamily::MotionBlur) {
        options.motionBlur.sampleCount = options.samples;
        if (Status valid = motion_blur::validate(options.motionBlur); !valid)
            return makeError("--samples: {}", valid.error().message);
    }
    if (arguments.pixel == "box")
        options.pixel = accumulate::PixelModel::Box;
    else if (arguments.pixel != "centre")
        return makeError("--pixel '{}' is not one of centre, box", arguments.pixel);
    const MethodFamily family = options.method->family;
    if (options.pixel == accumulate::PixelModel::Box && family != MethodFamily::Accumulate &&
        family != MethodFamily::Truth)
        return makeError(
            "--pixel box needs a method that takes many samples a pixel: accumulate or truth"
        );
    if (arguments.error && family != MethodFamily::Truth)
        return makeError("--error needs a method that estimates its error: truth");
    // Written so that NaN fails.
    if (arguments.error && !(*arguments.error > 0.0 && std::isfinite(*arguments.error)))
        return makeError("--error {} must be above 0", *arguments.error);
    options.error = arguments.error;
    for (const std::string& setting : arguments.settings)
        if (Status applied = applySetting(setting, *options.method, options.motionBlur); !applied)
            return applied;
    if (options.method->blur)
        options.motionBlur.method = options.method->blur;
    if (Status valid = motion_blur::validate(options.motionBlur); !valid)
        return makeError("--set: {}", valid.error().message);
    return {};
}

Status parseBudget(const RenderArguments& arguments, RenderOptions& options) {
    if (!arguments.budgetMilliseconds)
        return {};
    if (options.method->family != MethodFamily::MotionBlur)
        return makeError("--budget: method {} has nothing to give up", options.method->name);
    options.budget.milliseconds = *arguments.budgetMilliseconds;
    if (Status valid = motion_blur::validate(options.budget); !valid)
        return makeError("--budget: {}", valid.error().message);
    return {};
}

Status parseAovs(const RenderArguments& arguments, RenderOptions& options) {
    if (arguments.aov.empty())
        return {};
    std::set<std::string> known = {"motion", "depth", "normal", "mesh_id"};
    known.insert(options.method->aovs.begin(), options.method->aovs.end());
    if (arguments.aov == "all") {
        options.aovs = known;
        return {};
    }
    for (const std::string& name : splitAt(arguments.aov, ',')) {
        if (!known.contains(name))
            return makeError(
                "--aov '{}' is not written by method {}, which has {}",
                name,
                options.method->name,
                fmt::join(known, ", ")
            );
        options.aovs.insert(name);
    }
    return {};
}

Status parseFilm(const RenderArguments& arguments, RenderOptions& options) {
    if (!isFilm(arguments.out)) {
        if (!arguments.ffmpeg.empty() || arguments.keepFrames)
            return makeError(
                "{} needs --out FILE.mp4", arguments.keepFrames ? "--keep-frames" : "--ffmpeg"
            );
        return {};
    }
    if (!options.isSequence)
        return makeError("--out '{}' needs --frames or --flythrough", arguments.out);
    if (!options.aovs.empty())
        return makeError("--aov needs --out of pictures: '{}' is a film", arguments.out);
    if (options.width % 2 != 0 || options.height % 2 != 0)
        return makeError("--size {}: the sides of an .mp4 must be even", arguments.size);
    options.film = arguments.out;
    options.out = filmFrames(options.film);
    options.ffmpeg = arguments.ffmpeg;
    options.keepFrames = arguments.keepFrames;
    return {};
}

Status parseOutput(const RenderArguments& arguments, RenderOptions& options) {
    options.out = arguments.out;
    if (Status parsed = parseFilm(arguments, options); !parsed)
        return parsed;
    auto display = io::isDisplayFormat(options.out);
    if (!display)
        return core::makeError("--out: {}", display.error().message);
    options.displayOut = display.value();
    // A flythrough whose frames are not planned yet has more than one.
    if (options.isSequence && options.frameTimes.size() != 1 &&
        frameFile(options.out, 0) == frameFile(options.out, 1))
        return makeError("--out '{}' needs a frame number such as %04d", arguments.out);
    auto tonemap = interpretTonemap(arguments.tonemap, arguments.exposureValue);
    if (!tonemap)
        return tonemap.error();
    options.tonemap = tonemap.value();
    // Unlit pictures show the materials' own colours.
    if (arguments.unlit)
        options.tonemap.op = tonemap::Operator::None;
    return {};
}

Status checkStatsWritable(const RenderOptions& options) {
    if (options.stats.empty())
        return {};
    std::error_code ignored;
    const auto folder = options.stats.has_parent_path() ? options.stats.parent_path() : ".";
    if (std::filesystem::is_directory(options.stats, ignored))
        return makeError("--stats: cannot write '{}': it is a folder", options.stats.string());
    if (!std::filesystem::is_directory(folder, ignored))
        return makeError(
            "--stats: cannot write '{}': the folder '{}' does not exist",
            options.stats.string(),
            folder.string()
        );
    // A file is renamed into place, so its folder has to allow it; a pipe or a device is written
    // to.
    const bool isOther = std::filesystem::exists(options.stats, ignored) &&
                         !std::filesystem::is_regular_file(options.stats, ignored);
    if (::access(isOther ? options.stats.c_str() : folder.c_str(), W_OK) != 0)
        return makeError("--stats: cannot write '{}': permission denied", options.stats.string());
    return {};
}

} // namespace

void defineShotOptions(CLI::App& command, RenderArguments& a) {
    command.add_option(
        "--camera", a.camera, "name or index; default: the first, or one made to fit"
    );
    command.add_option("--time", a.time, "seconds; default 0");
    command.add_option("--fps", a.fps, "F, frames a second; default 24");
    command.add_option("--clip", a.clips, "clip to play (repeatable), or none; default: all");
    command.add_flag("--loop", a.loop, "clips start again at their ends; default: hold");
    defineShutterOptions(command, a);
    command.add_option("--pixel", a.pixel, "centre (default) or box");
    command.add_option("--seed", a.seed, "of the times (truth) and of --pixel box's places");
    command.add_flag("--unlit", a.unlit, "base colour only");
    command.add_option("--background", a.background, "R,G,B linear; default 0.18,0.18,0.18");
    command.add_option("--ambient", a.ambient, "uniform light, R,G,B; default 0.25,0.25,0.25");
    defineTonemapOptions(command, a.tonemap, a.exposureValue);
}

void defineDeviceOptions(CLI::App& command, RenderArguments& a) {
    command.add_option("--device", a.device, "name or index, see `shutter info --devices`");
    command.add_option(
        "--rays",
        a.rays,
        "best way to trace rays: query (default), pipeline or none hide those above"
    );
    command.add_flag("--validate", a.validate, "Vulkan validation; a message is a failure");
}

void defineRenderOptions(CLI::App& command, RenderArguments& a) {
    command.add_option("scene", a.scene, "glTF 2.0 scene, .gltf or .glb")->required();
    command
        .add_option(
            "--out", a.out, ".exr (linear), .png or .jpg; %04d for sequences; .mp4 (by ffmpeg)"
        )
        ->required();
    defineShotOptions(command, a);
    command.add_option("--frames", a.frames, "A:B, a frame's time is its number / F")
        ->excludes(command.get_option("--time"));
    command
        .add_option(
            "--flythrough",
            a.flythrough,
            "FILE.json of camera keys, or clip:NAME of the scene's; all of its frames by default"
        )
        ->excludes(command.get_option("--time"));
    command.add_flag("--restart", a.restart, "draw frames again that are complete on disk");
    command.add_option("--ffmpeg", a.ffmpeg, "the program, for .mp4; default: the one on PATH");
    command.add_flag("--keep-frames", a.keepFrames, "keep FILE.mp4.frames when the film is made");
    command.add_option("--method", a.method, "see `shutter info --methods`; default hybrid");
    command.add_option(
        "--samples",
        a.samples,
        "taps (gathers), instants (accumulate), rays a pixel (truth, denoised)"
    );
    command.add_option("--error", a.error, "truth: stop at this standard error (linear RMS)");
    command.add_option("--size", a.size, "WxH; default 1280x720");
    command.add_option("--set", a.settings, "NAME=VALUE of the method's settings (repeatable)");
    command.add_option(
        "--aov", a.aov, "intermediates to write beside --out, comma-separated, or all"
    );
    command.add_option("--stats", a.stats, "times and counters as JSON");
    defineDeviceOptions(command, a);
    command.add_flag("--dump-graph", a.dumpGraph, "print the render graph of the first frame");
    command.add_option(
        "--budget",
        a.budgetMilliseconds,
        "GPU ms a frame that the blur may take (it gives up quality); default: no limit"
    );
    command.add_flag(
        "--explain", a.explain, "print of each frame why each effect and pass ran or was skipped"
    );
    command.add_option("--repeat", a.repeat, "draw each frame N times more, report median times")
        ->check(CLI::Range(1u, 1000u));
}

core::Result<RenderOptions> interpret(const RenderArguments& arguments) {
    RenderOptions options;
    options.scene = arguments.scene;
    options.camera = arguments.camera;
    options.clips = arguments.clips;
    options.loop = arguments.loop;
    options.seed = arguments.seed;
    options.unlit = arguments.unlit;
    options.device = arguments.device;
    auto tier = interpretRays(arguments.rays);
    if (!tier)
        return tier.error();
    options.bestTier = tier.value();
#ifdef NDEBUG
    options.validate = arguments.validate;
#else
    options.validate = true; // every debug run is a validated run
#endif
    options.dumpGraph = arguments.dumpGraph;
    options.explain = arguments.explain;
    options.repeat = arguments.repeat;
    options.restart = arguments.restart;
    options.pictureOptions = arguments.pictureOptions;
    options.stats = arguments.stats;
    using Step = Status (*)(const RenderArguments&, RenderOptions&);
    const Step parseSizeOption = [](const RenderArguments& a, RenderOptions& o) {
        return parseSize(a.size, o);
    };
    for (const Step step :
         {parseSizeOption,
          Step(parseTimes),
          Step(parseFlythrough),
          Step(parseShutter),
          Step(parseMethod),
          Step(parseBudget),
          Step(parseAovs),
          Step(parseOutput)})
        if (Status parsed = step(arguments, options); !parsed)
            return parsed.error();
    auto background = parseColor("--background", arguments.background);
    if (!background)
        return background.error();
    options.background = background.value();
    auto ambient = parseColor("--ambient", arguments.ambient);
    if (!ambient)
        return ambient.error();
    options.ambient = ambient.value();
    return options;
}

core::Status planFrames(const char* option, double first, double last, RenderOptions& options) {
    const double fps = options.fps;
    if (!(last - first < kMaxFrames))
        return makeError("{}: {} frames are too many", option, last - first + 1.0);
    // Written so that NaN fails.
    if (!(std::max(std::abs(first), std::abs(last)) / fps <= kMaxSeconds))
        return makeError(
            "{}: frames {}:{} at {} a second lie beyond {} seconds",
            option,
            first,
            last,
            fps,
            kMaxSeconds
        );
    if (!(std::max(std::abs(first), std::abs(last)) < double(std::numeric_limits<int>::max())))
        return makeError("{}: frames {:.0f}:{:.0f} have no numbers", option, first, last);
    options.firstFrame = int(first);
    options.frameTimes.clear();
    for (double frame = first; frame <= last; ++frame)
        options.frameTimes.push_back(frame / fps);
    return {};
}

std::string describePictureOptions(const CLI::App& command) {
    static const std::set<std::string> kNoMatter = {
        "scene",
        "--out",
        "--frames",
        "--time",
        "--flythrough",
        "--device",
        "--stats",
        "--explain",
        "--dump-graph",
        "--repeat",
        "--validate",
        "--restart",
        "--ffmpeg",
        "--keep-frames"};
    std::string all;
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 || kNoMatter.contains(name))
            continue;
        all += fmt::format("{} {} ", name, fmt::join(option->results(), " "));
    }
    return all;
}

core::Status checkOutputs(const RenderOptions& options) {
    // A film's frames have a folder of their own, which is not there yet.
    if (!options.film.empty())
        return checkStatsWritable(options);
    if (Status writable = io::checkWritable(frameFile(options.out, options.firstFrame)); !writable)
        return core::makeError("--out: {}", writable.error().message);
    return checkStatsWritable(options);
}

std::filesystem::path frameFile(const std::filesystem::path& pattern, int frameNumber) {
    static const std::regex kNumber("%0?([0-9]?)d");
    const std::string text = pattern.string();
    std::smatch match;
    if (!std::regex_search(text, match, kNumber))
        return pattern;
    const int width = match[1].length() > 0 ? std::stoi(match[1]) : 0;
    return match.prefix().str() + fmt::format("{:0{}}", frameNumber, width) + match.suffix().str();
}

} // namespace shutter::game
