// SPDX-License-Identifier: MIT
#include "game/options/render_arguments.h"

#include "engine/io/image_file.h"
#include "game/options/option_rows.h"
#include "game/output/sequence.h"
#include "game/shot/picture_drawer.h"

#include <algorithm>
#include <array>
#include <regex>
#include <utility>

namespace shutter::game {

namespace {

using core::makeError;
using core::Status;

/// Words of --rays, in the order of gpu::RayTier.
constexpr std::string_view kTierWords[] = {"query", "pipeline", "none"};

/// Words of --codec, in the order of io::VideoCodec, whose Vp9 is not for films on their own.
constexpr std::string_view kCodecWords[] = {"h264", "av1", "prores"};

using O = OutputArguments;

constexpr std::array kOutputRows = {
    makeRow<&O::restart>(
        "--restart", "draw frames again even if they are complete on disk", Matters::ToNoPicture
    ),
    makeRow<&O::ffmpeg>(
        "--ffmpeg", "program that encodes films; default: the one on PATH", Matters::ToNoPicture
    ),
    makeRow<&O::keepFrames>(
        "--keep-frames", "keep FILE.mp4.frames after the film is made", Matters::ToNoPicture
    ),
    makeOptionalWordRow<&O::codec, kCodecWords>(
        "--codec",
        "codec of the film: h264 (default), av1 or prores (FILE.mov, 10 bits)",
        Matters::ToNoPicture
    ),
    makeRow<&O::bitDepth>(
        "--bit-depth",
        "bits of a film's channel, 8 (default) or 10",
        Matters::ToNoPicture // it counts as it is resolved
    ),
    makeRow<&O::timecode>(
        "--timecode",
        "time code of the first frame of a film or of EXR pictures, HH:MM:SS:FF (hours 00 to 23), "
        "or "
        "frame: that of its number",
        Matters::ToNoPicture
    ),
    makeRow<&O::aov>("--aov", "intermediates to write next to --out, comma-separated, or all"),
    makeRow<&O::stats>("--stats", "write times and counters to a JSON file", Matters::ToNoPicture),
    makeRow<&O::hashPasses>(
        "--hash-passes",
        "write a hash of each image that each pass writes to a JSON file",
        Matters::ToNoPicture
    ),
    makeRow<&O::dumpGraph>(
        "--dump-graph", "print the render graph of the first frame", Matters::ToNoPicture
    ),
    makeRow<&O::explain>(
        "--explain",
        "print for each frame why each effect and pass ran or was skipped",
        Matters::ToNoPicture
    ),
    makeRow<&O::part>(
        "--part",
        "K/N: of N parts of a sequence draw the Kth, each Nth frame, and make no film",
        Matters::ToNoPicture
    ),
    makeRow<&O::dryRun>(
        "--dry-run",
        "check options and files, print the number of frames and draw nothing",
        Matters::ToNoPicture
    ),
};

bool isFilm(const std::filesystem::path& out) {
    const std::string extension = io::lowerExtension(out);
    return extension == ".mp4" || extension == ".mov";
}

Status
interpretAovs(const OutputArguments& arguments, const MethodInfo& method, OutputOptions& options) {
    if (arguments.aov.empty())
        return {};
    const std::set<std::string> known = listIntermediates(method);
    if (arguments.aov == "all") {
        options.aovs = known;
        return {};
    }
    for (const std::string& name : splitAt(arguments.aov, ',')) {
        if (!known.contains(name))
            return makeError(
                "--aov '{}' is not written by method {}, which has {}",
                name,
                method.name,
                fmt::join(known, ", ")
            );
        options.aovs.insert(name);
    }
    return {};
}

core::Result<io::VideoFormat> interpretFormat(const OutputArguments& arguments) {
    io::VideoFormat format;
    format.codec = arguments.codec.value_or(io::VideoCodec::H264);
    const bool isProRes = format.codec == io::VideoCodec::ProRes;
    format.bitDepth = arguments.bitDepth.value_or(isProRes ? 10 : 8);
    if (format.bitDepth != 8 && format.bitDepth != 10)
        return makeError("--bit-depth {} must be 8 or 10", format.bitDepth);
    if (isProRes && format.bitDepth == 8)
        return makeError("--bit-depth 8: --codec prores has 10 bits");
    if (isProRes && io::lowerExtension(arguments.out) != ".mov")
        return makeError("--codec prores needs --out FILE.mov");
    static const std::regex kTimecode("[0-9]{2}:[0-5][0-9]:[0-5][0-9]:[0-9]{2}");
    format.timecode = arguments.timecode;
    if (!format.timecode.empty() && format.timecode != kTimecodeOfFrame &&
        !std::regex_match(format.timecode, kTimecode))
        return makeError("--timecode '{}' is not HH:MM:SS:FF, nor frame", format.timecode);
    return format;
}

constexpr const char* kTimecodeOption = "--timecode";

/// An option about films that was typed; null: none was.
const char* findFilmOption(const OutputArguments& arguments) {
    if (arguments.keepFrames)
        return "--keep-frames";
    if (!arguments.ffmpeg.empty())
        return "--ffmpeg";
    if (arguments.codec)
        return "--codec";
    if (arguments.bitDepth)
        return "--bit-depth";
    return arguments.timecode.empty() ? nullptr : kTimecodeOption;
}

Status interpretFilm(const RenderArguments& all, const ShotOptions& shot, OutputOptions& options) {
    const OutputArguments& arguments = all.output;
    if (!isFilm(arguments.out)) {
        const char* option = findFilmOption(arguments);
        if (!option)
            return {};
        if (std::string_view(option) != kTimecodeOption)
            return makeError("{} needs --out FILE.mp4", option);
        if (!shot.isSequence || io::lowerExtension(arguments.out) != ".exr")
            return makeError("{} needs --out FILE.mp4, or a sequence of EXR", option);
        const auto format = interpretFormat(arguments);
        if (!format)
            return format.error();
        options.video.timecode = format.value().timecode;
        return {};
    }
    if (!shot.isSequence)
        return makeError("--out '{}' needs --frames or --flythrough", arguments.out);
    if (!options.aovs.empty())
        return makeError("--aov needs --out of pictures: '{}' is a film", arguments.out);
    if (shot.width % 2 != 0 || shot.height % 2 != 0)
        return makeError("--size {}x{}: the sides of a film must be even", shot.width, shot.height);
    auto format = interpretFormat(arguments);
    if (!format)
        return format.error();
    options.video = std::move(format).value();
    options.film = arguments.out;
    options.out = filmFrames(options.film);
    options.ffmpeg = arguments.ffmpeg;
    options.keepFrames = arguments.keepFrames;
    return {};
}

Status interpretOut(const RenderArguments& all, const ShotOptions& shot, OutputOptions& options) {
    options.out = all.output.out;
    SHUTTER_TRY(interpretFilm(all, shot, options));
    auto display = io::isDisplayFormat(options.out, ".exr, .png, .jpg, .mp4 or .mov");
    if (!display)
        return makeError("--out: {}", display.error().message);
    options.displayOut = display.value();
    // A flythrough whose frames are not planned yet has more than one.
    if (shot.isSequence && shot.frameTimes.size() != 1 &&
        frameFile(options.out, 0) == frameFile(options.out, 1))
        return makeError(
            "--out '{}' needs a frame number such as %04d in the file's own name", all.output.out
        );
    return {};
}

/// An option that has every frame drawn, complete or not: a part could not go on where it stopped.
const char* findRedrawOption(const OutputArguments& arguments) {
    if (!arguments.stats.empty())
        return "--stats";
    if (arguments.dumpGraph)
        return "--dump-graph";
    if (arguments.explain)
        return "--explain";
    return arguments.repeat > 1 ? "--repeat" : nullptr;
}

Status interpretPart(
    const RenderArguments& all,
    const ShotOptions& shot,
    const MethodOptions& method,
    OutputOptions& options
) {
    const std::string& text = all.output.part;
    if (text.empty())
        return {};
    static const std::regex kShape("([0-9]{1,5})/([0-9]{1,5})");
    std::smatch match;
    const bool isShaped = std::regex_match(text, match, kShape);
    const auto part = isShaped ? uint32_t(std::stoul(match[1])) : 0;
    const auto count = isShaped ? uint32_t(std::stoul(match[2])) : 0;
    if (part < 1 || part > count)
        return makeError("--part '{}' is not K/N with K from 1 to N", text);
    if (!shot.isSequence)
        return makeError("--part needs --frames or --flythrough");
    if (const char* option = findRedrawOption(all.output))
        return makeError("--part and {} exclude each other", option);
    if (count > 1 && !method.budget.isUnlimited())
        return makeError(
            "--budget makes a frame depend on how fast those before were drawn, which parts do not "
            "share"
        );
    if (count > 1 && shot.picture.antiAliasing == AntiAliasing::Taa)
        return makeError(
            "{} makes a frame depend on all before it, which parts do not share: use --aa box",
            all.shot.typed.contains("--aa")
                ? "--aa taa"
                : "--preset " + all.method.preset + " sets --aa taa, which"
        );
    options.part = FramePart{part - 1, count};
    return {};
}

core::Result<OutputOptions>
interpretOutput(const RenderArguments& all, const ShotOptions& shot, const MethodOptions& method) {
    OutputOptions options;
    options.dryRun = all.output.dryRun;
    options.restart = all.output.restart;
    options.stats = all.output.stats;
    options.hashPasses = all.output.hashPasses;
    if (!options.hashPasses.empty() && shot.isSequence)
        return makeError("--hash-passes is about a single picture: no --frames, no --flythrough");
    options.dumpGraph = all.output.dumpGraph;
    options.explain = all.output.explain;
    options.repeat = all.output.repeat;
    SHUTTER_TRY(interpretAovs(all.output, *method.method, options));
    SHUTTER_TRY(interpretOut(all, shot, options));
    SHUTTER_TRY(interpretPart(all, shot, method, options));
    return options;
}

} // namespace

void defineDeviceOptions(CLI::App& command, gpu::DeviceOptions& options) {
    using D = gpu::DeviceOptions;
    static constexpr std::array kRows = {
        makeRow<&D::wanted>("--device", "device by name or index, see `shutter info --devices`"),
        makeWordRow<&D::bestTier, kTierWords>(
            "--rays", "limit how rays are traced: query (default, no limit), pipeline or none"
        ),
        makeRow<&D::validate>("--validate", "turn on Vulkan validation; any message is a failure"),
        makeRow<&D::wantsAdvice>(
            "--advice", "with --validate: print what the layer advises (best practices), too"
        ),
    };
#ifndef NDEBUG
    options.validate = true; // every debug run is a validated run
#endif
    defineRows(command, OptionRows<D>(kRows), options);
}

void defineRenderOptions(CLI::App& command, RenderArguments& a) {
    command.add_option("scene", a.shot.scene, "glTF 2.0 scene, .gltf or .glb")->required();
    command
        .add_option(
            "--out",
            a.output.out,
            "output: .exr (linear), .png or .jpg; %04d for sequences; .mp4 or .mov (needs ffmpeg)"
        )
        ->required();
    defineSceneOptions(command, a.shot);
    defineShotOptions(command, a.shot);
    defineLensOptions(command, a.shot);
    defineSizeOption(command, a.shot);
    defineFlythroughOption(command, a.shot);
    defineFrameOptions(command, a.shot);
    defineMethodOptions(command, a.method);
    defineRows(command, OptionRows<O>(kOutputRows), a.output);
    command
        .add_option(
            "--repeat", a.output.repeat, "draw each frame N more times and report median times"
        )
        ->check(CLI::Range(1u, 1000u));
    defineDeviceOptions(command, a.device);
}

namespace {

Status checkPixel(const ShotOptions& shot, const MethodInfo& method) {
    if (shot.pixel == extract::PixelModel::Box && method.family != MethodFamily::Accumulate &&
        method.family != MethodFamily::Truth)
        return makeError(
            "--pixel box needs a method that takes many samples per pixel: accumulate or truth"
        );
    return {};
}

Status checkLens(const ShotOptions& shot, const MethodInfo& method) {
    const bool opens = shot.fStop.value_or(0.0) != 0.0;
    const bool focuses = shot.focusDistance || !shot.focusEntity.empty();
    if (method.hasLens || (!opens && !focuses))
        return {};
    return makeError(
        "{}: method {} has no lens yet; use {}",
        opens ? "--fstop" : nameFocusOption(shot),
        method.name,
        listLensMethods("or")
    );
}

Status checkAntiAliasing(const ShotOptions& shot, const MethodInfo& method) {
    if (shot.picture.antiAliasing == AntiAliasing::None || !isSampledAnyway(method))
        return {};
    if (method.family == MethodFamily::MotionBlur)
        return makeError(
            "--aa is about the raster image, which method {} does not draw", method.name
        );
    return makeError(
        "--aa is about the raster image: method {} has --pixel box instead", method.name
    );
}

/// The shot's arguments with what the preset sets, except where an option was typed.
ShotArguments applyPreset(const RenderArguments& arguments) {
    ShotArguments shot = arguments.shot;
    if (const PresetEffects* effects = findPresetEffects(arguments.method.preset))
        apply(*effects, shot.picture, shot.typed);
    return shot;
}

bool usesLens(const RenderArguments& arguments) {
    const PresetEffects* effects = findPresetEffects(arguments.method.preset);
    const ShotArguments& shot = arguments.shot;
    return !effects || effects->depthOfField || shot.typed.contains("--fstop") ||
           shot.typed.contains("--focus") || !shot.focusEntity.empty();
}

} // namespace

core::Result<RenderOptions> interpret(const RenderArguments& arguments) {
    RenderOptions options;
    const ShotArguments shotArguments = applyPreset(arguments);
    auto shot = interpret(shotArguments);
    if (!shot)
        return shot.error();
    options.shot = std::move(shot).value();
    auto method = interpret(arguments.method);
    if (!method)
        return method.error();
    options.method = std::move(method).value();
    options.shot.usesLens = usesLens(arguments);
    SHUTTER_TRY(checkPixel(options.shot, *options.method.method));
    SHUTTER_TRY(checkLens(options.shot, *options.method.method));
    SHUTTER_TRY(checkAntiAliasing(options.shot, *options.method.method));
    auto output = interpretOutput(arguments, options.shot, options.method);
    if (!output)
        return output.error();
    options.output = std::move(output).value();
    options.device = arguments.device;
    options.fingerprint = fmt::format(
        "{} {} {} --rays={}",
        describe(shotArguments),
        describe(arguments.method),
        describeRows(OptionRows<O>(kOutputRows), arguments.output),
        kTierWords[static_cast<size_t>(options.device.bestTier)]
    );
    if (options.output.isDeep())
        options.fingerprint += " --bit-depth=10";
    if (options.output.film.empty() && !options.output.video.timecode.empty())
        options.fingerprint += " --timecode=" + options.output.video.timecode; // in each picture
    return options;
}

} // namespace shutter::game
