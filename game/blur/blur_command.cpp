// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/io/image_file.h"
#include "game/blur/blur_run.h"
#include "game/options/method_arguments.h"
#include "game/options/option_rows.h"
#include "game/options/program.h"
#include "game/options/render_arguments.h"
#include "game/output/render_options.h"
#include "game/shot/methods.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace shutter::blur {

namespace {

using core::makeError;
using core::Status;
using game::makeOptionalWordRow;
using game::makeRow;
using game::makeWordRow;

enum class Phase : uint8_t { Start, Centre, End };

constexpr std::array<std::string_view, 3> kPhaseWords{"start", "centre", "end"};

struct Arguments {
    std::string color;
    std::string motion;
    std::string depth;
    std::string out;
    std::string cameras;
    std::string ids;
    std::string frames;
    std::string aov;
    std::string motionScale = "1,1";
    std::optional<Vectors> vectors;
    Depth depthKind = Depth::View;
    double near = 0.1;
    double far = 0.0;
    double angle = 180.0;
    Phase phase = Phase::End;
    bool restart = false;
    bool hasMethod = false; ///< --method or --preset was typed
    game::MethodArguments method;
    tonemap::TonemapSettings tonemap;
    std::set<std::string> typed;
    gpu::DeviceOptions device;
};

using A = Arguments;

constexpr std::array kRows{
    makeRow<&A::out>("--out", "picture to write, .exr, .png or .jpg; of frames with %04d"),
    makeRow<&A::cameras>("--camera", "JSON file of the pictures' cameras"),
    makeRow<&A::ids>("--ids", "picture of entity ids, channel mesh_id, -1 for none, for resolved"),
    makeRow<&A::frames>(
        "--frames", "frames A to B, as A:B, or one, for names with %04d and for --camera; default 0"
    ),
    makeOptionalWordRow<&A::vectors, kVectorsWords>(
        "--vectors",
        "what MOTION is: exposure (pixels right and down over the exposure, as --aov motion), "
        "previous (the same from the previous frame to this one), next (from this frame to the "
        "next), blender (Cycles' pass Vector) or nuke (forward and backward); default: by the "
        "channels' names"
    ),
    makeRow<&A::motionScale>(
        "--motion-scale", "X,Y: factors from MOTION to the unit and direction of --vectors"
    ),
    makeWordRow<&A::depthKind, kDepthWords>(
        "--depth",
        "what DEPTH is: view (default: distance along the view), inverse (1 / distance, Nuke), "
        "device (0 near, 1 far) or reversed (1 near, 0 far)"
    ),
    makeRow<&A::near>("--near", "near plane of --depth device and reversed; default 0.1"),
    makeRow<&A::far>("--far", "far plane of the same; default 0: infinite"),
    makeRow<&A::angle>(
        "--shutter-angle", "degrees, 360 for the time between two frames; default 180"
    ),
    makeWordRow<&A::phase, kPhaseWords>(
        "--phase", "where in the exposure the pictures are: start, centre or end (default)"
    ),
    makeRow<&A::aov>(
        "--aov",
        "intermediates to write next to --out, comma-separated, or all",
        game::Matters::ToPictures
    ),
    makeRow<&A::restart>(
        "--restart", "draw frames again that are complete on disk", game::Matters::ToNoPicture
    ),
};

Status interpretMethod(const Arguments& arguments, BlurOptions& options) {
    game::MethodArguments wanted = arguments.method;
    if (!arguments.hasMethod)
        wanted.method = motion_blur::getDefaultMethod(!arguments.cameras.empty()).name;
    const auto method = game::interpret(wanted);
    if (!method)
        return method.error();
    SHUTTER_TRY(checkMethod(
        method.value().method->blur, method.value().method->name, !arguments.cameras.empty()
    ));
    options.settings = method.value().motionBlur;
    if (arguments.method.typed.contains("--budget"))
        return makeError("--budget is not for pictures");
    return {};
}

Status interpretFrames(const Arguments& arguments, BlurOptions& options) {
    const bool isPattern = game::frameFile(arguments.out, 0) != game::frameFile(arguments.out, 1);
    static const std::regex kPattern("(-?[0-9]{1,7})(:(-?[0-9]{1,7}))?");
    std::smatch match;
    if (arguments.frames.empty())
        return isPattern ? makeError("--out '{}' needs --frames", arguments.out) : Status();
    if (!std::regex_match(arguments.frames, match, kPattern))
        return makeError("--frames '{}' is not A:B, e.g. 0:23", arguments.frames);
    options.firstFrame = std::stoi(match[1]);
    options.lastFrame = match[3].matched ? std::stoi(match[3]) : options.firstFrame;
    if (options.lastFrame < options.firstFrame)
        return makeError("--frames {}: the last comes before the first", arguments.frames);
    options.isSequence = true;
    if (options.lastFrame > options.firstFrame && !isPattern)
        return makeError(
            "--out '{}' needs a frame number such as %04d in the file's own name", arguments.out
        );
    return {};
}

Status interpretPasses(const Arguments& arguments, BlurOptions& options) {
    options.files = {arguments.color, arguments.motion, arguments.depth, arguments.ids};
    options.passes.vectors = arguments.vectors;
    options.passes.depth = arguments.depthKind;
    options.passes.near = arguments.near;
    options.passes.far = arguments.far;
    const std::vector<std::string> factors = game::splitAt(arguments.motionScale, ',');
    for (size_t i = 0; i < 2; ++i) {
        const auto factor = factors.size() == 2 ? core::parseNumber(factors[i]) : std::nullopt;
        if (!factor || !std::isfinite(*factor) || *factor == 0.0)
            return makeError(
                "--motion-scale '{}' is not X,Y, which are not 0", arguments.motionScale
            );
        options.passes.motionScale[int(i)] = float(*factor);
    }
    // Written so that NaN fails.
    if (!(arguments.near > 0.0 && std::isfinite(arguments.near)))
        return makeError("--near {} must be above 0", arguments.near);
    if (arguments.far != 0.0 && !(arguments.far > arguments.near))
        return makeError("--far {} must be 0 or above --near {}", arguments.far, arguments.near);
    constexpr double kMaxAngle = 360.0 * 16.0;
    if (!(arguments.angle > 0.0 && arguments.angle <= kMaxAngle))
        return makeError(
            "--shutter-angle {} must be above 0 and at most {}", arguments.angle, kMaxAngle
        );
    options.shutter.exposureShare = options.passes.exposureShare = arguments.angle / 360.0;
    options.shutter.rasterTime = options.passes.rasterTime = 0.5 * double(arguments.phase);
    return {};
}

core::Result<BlurOptions> interpret(const Arguments& arguments) {
    BlurOptions options;
    options.out = arguments.out;
    options.cameras = arguments.cameras;
    options.restart = arguments.restart;
    options.tonemap = arguments.tonemap;
    for (const std::string& name : game::splitAt(arguments.aov, ','))
        if (!name.empty())
            options.aovs.push_back(name);
    if (const auto format = io::isDisplayFormat(options.out); !format)
        return makeError("--out: {}", format.error().message);
    for (const auto step : {interpretMethod, interpretFrames, interpretPasses})
        SHUTTER_TRY(step(arguments, options));
    options.fingerprint = fmt::format(
        "{} {} {}",
        game::describeRows(game::OptionRows<A>(kRows), arguments),
        game::describe(arguments.method),
        core::describeValues(tonemap::listTonemapRows(), arguments.tonemap)
    );
    return options;
}

/// A picture is not replaced by what is made of it.
bool isInput(const BlurOptions& options) {
    const PassFiles& files = options.files;
    std::error_code ignored;
    for (const auto& file : {files.color, files.motion, files.depth, files.ids})
        if (file == options.out || std::filesystem::equivalent(file, options.out, ignored))
            return true;
    return false;
}

int run(const Arguments& arguments) {
    const auto options = interpret(arguments);
    if (!options)
        return game::fail(game::kExitUsage, options.error());
    if (isInput(options.value()))
        return game::fail(
            game::kExitUsage, makeError("--out '{}' is one of the pictures to blur", arguments.out)
        );
    if (const Status writable =
            io::checkWritable(game::frameFile(options.value().out, options.value().firstFrame));
        !writable)
        return game::fail(game::kExitFailed, makeError("--out: {}", writable.error().message));
    auto device = gpu::Device::create(arguments.device);
    if (!device)
        return game::fail(game::kExitFailed, device.error());
    if (const Status done = blur(options.value(), *device.value()); !done)
        return game::fail(game::kExitFailed, done.error());
    if (const uint32_t messages = device.value()->validationMessageCount(); messages > 0)
        return game::fail(
            game::kExitFailed, core::Error{core::countOf(messages, "Vulkan validation message")}
        );
    return game::kExitDone;
}

} // namespace

void addBlurCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command =
        app.add_subcommand("blur", "blur pictures of any renderer: colour, motion and depth");
    auto arguments = std::make_shared<Arguments>();
    command->add_option("COLOUR", arguments->color, "picture, linear R, G, B (A)")->required();
    command->add_option("MOTION", arguments->motion, "its motion vectors, see --vectors")
        ->required();
    command
        ->add_option("DEPTH", arguments->depth, "its depth, see --depth; may be the same file, too")
        ->required();
    game::defineRows(*command, game::OptionRows<A>(kRows), *arguments);
    command->get_option("--out")->required();
    game::defineMethodOptions(*command, arguments->method);
    command->get_option("--method")
        ->description("method, see `shutter info --methods`; default gather, with --camera resolved"
        );
    game::defineSettingOptions(
        *command, tonemap::listTonemapRows(), arguments->tonemap, arguments->typed
    );
    game::defineDeviceOptions(*command, arguments->device);
    command->callback([arguments, command, &exitStatus] {
        arguments->hasMethod = command->count("--method") > 0 || command->count("--preset") > 0;
        exitStatus = run(*arguments);
    });
}

} // namespace shutter::blur
