// SPDX-License-Identifier: MIT
#include "game/options/render_arguments.h"

#include "engine/io/image_file.h"
#include "game/options/option_rows.h"
#include "game/output/sequence.h"
#include "game/shot/picture_drawer.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace shutter::game {

namespace {

using core::makeError;
using core::Status;

/// Words of --rays, in the order of gpu::RayTier.
constexpr std::string_view kTierWords[] = {"query", "pipeline", "none"};

using O = OutputArguments;

constexpr std::array kOutputRows = {
    makeRow<&O::restart>(
        "--restart", "draw frames again even if they are complete on disk", Matters::ToNoPicture
    ),
    makeRow<&O::ffmpeg>(
        "--ffmpeg", "program that encodes .mp4; default: the one on PATH", Matters::ToNoPicture
    ),
    makeRow<&O::keepFrames>(
        "--keep-frames", "keep FILE.mp4.frames after the film is made", Matters::ToNoPicture
    ),
    makeRow<&O::aov>("--aov", "intermediates to write beside --out, comma-separated, or all"),
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
};

bool isFilm(const std::filesystem::path& out) {
    std::string extension = out.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
        return char(std::tolower(c));
    });
    return extension == ".mp4";
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

Status interpretFilm(const RenderArguments& all, const ShotOptions& shot, OutputOptions& options) {
    const OutputArguments& arguments = all.output;
    if (!isFilm(arguments.out)) {
        if (!arguments.ffmpeg.empty() || arguments.keepFrames)
            return makeError(
                "{} needs --out FILE.mp4", arguments.keepFrames ? "--keep-frames" : "--ffmpeg"
            );
        return {};
    }
    if (!shot.isSequence)
        return makeError("--out '{}' needs --frames or --flythrough", arguments.out);
    if (!options.aovs.empty())
        return makeError("--aov needs --out of pictures: '{}' is a film", arguments.out);
    if (shot.width % 2 != 0 || shot.height % 2 != 0)
        return makeError(
            "--size {}x{}: the sides of an .mp4 must be even", shot.width, shot.height
        );
    options.film = arguments.out;
    options.out = filmFrames(options.film);
    options.ffmpeg = arguments.ffmpeg;
    options.keepFrames = arguments.keepFrames;
    return {};
}

Status interpretOut(const RenderArguments& all, const ShotOptions& shot, OutputOptions& options) {
    options.out = all.output.out;
    SHUTTER_TRY(interpretFilm(all, shot, options));
    auto display = io::isDisplayFormat(options.out, ".exr, .png, .jpg or .mp4");
    if (!display)
        return makeError("--out: {}", display.error().message);
    options.displayOut = display.value();
    // A flythrough whose frames are not planned yet has more than one.
    if (shot.isSequence && shot.frameTimes.size() != 1 &&
        frameFile(options.out, 0) == frameFile(options.out, 1))
        return makeError("--out '{}' needs a frame number such as %04d", all.output.out);
    return {};
}

core::Result<OutputOptions>
interpretOutput(const RenderArguments& all, const ShotOptions& shot, const MethodInfo& method) {
    OutputOptions options;
    options.restart = all.output.restart;
    options.stats = all.output.stats;
    options.hashPasses = all.output.hashPasses;
    if (!options.hashPasses.empty() && shot.isSequence)
        return makeError("--hash-passes is about a single picture: no --frames, no --flythrough");
    options.dumpGraph = all.output.dumpGraph;
    options.explain = all.output.explain;
    options.repeat = all.output.repeat;
    SHUTTER_TRY(interpretAovs(all.output, method, options));
    SHUTTER_TRY(interpretOut(all, shot, options));
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
            "output: .exr (linear), .png or .jpg; %04d for sequences; .mp4 (needs ffmpeg)"
        )
        ->required();
    defineShotOptions(command, a.shot);
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

core::Status checkPixel(const ShotOptions& shot, const MethodInfo& method) {
    if (shot.pixel == extract::PixelModel::Box && method.family != MethodFamily::Accumulate &&
        method.family != MethodFamily::Truth)
        return makeError(
            "--pixel box needs a method that takes many samples per pixel: accumulate or truth"
        );
    return {};
}

core::Status checkAntiAliasing(const ShotOptions& shot, const MethodInfo& method) {
    if (shot.antiAliasing == AntiAliasing::None || !isSampledAnyway(method))
        return {};
    if (method.family == MethodFamily::MotionBlur)
        return makeError(
            "--aa is about the raster image, which method {} does not draw", method.name
        );
    return makeError(
        "--aa is about the raster image: method {} has --pixel box instead", method.name
    );
}

core::Result<RenderOptions> interpret(const RenderArguments& arguments) {
    RenderOptions options;
    auto shot = interpret(arguments.shot);
    if (!shot)
        return shot.error();
    options.shot = std::move(shot).value();
    auto method = interpret(arguments.method);
    if (!method)
        return method.error();
    options.method = std::move(method).value();
    SHUTTER_TRY(checkPixel(options.shot, *options.method.method));
    SHUTTER_TRY(checkAntiAliasing(options.shot, *options.method.method));
    auto output = interpretOutput(arguments, options.shot, *options.method.method);
    if (!output)
        return output.error();
    options.output = std::move(output).value();
    options.device = arguments.device;
    options.fingerprint = fmt::format(
        "{} {} {} --rays={}",
        describe(arguments.shot),
        describe(arguments.method),
        describeRows(OptionRows<O>(kOutputRows), arguments.output),
        kTierWords[static_cast<size_t>(options.device.bestTier)]
    );
    return options;
}

} // namespace shutter::game
