// SPDX-License-Identifier: MIT

#include "engine/core/words.h"
#include "engine/gpu/device.h"
#include "engine/io/image_file.h"
#include "game/options/method_arguments.h"
#include "game/options/program.h"
#include "game/options/render_arguments.h"
#include "game/replay/replay_run.h"
#include "game/shot/methods.h"

#include <CLI/CLI.hpp>

#include <memory>
#include <sstream>
#include <string>

namespace shutter::replay {

namespace {

using core::makeError;
using motion_blur::MotionBlurSettings;

struct Arguments {
    std::string folder;
    std::string out;
    std::string aov;
    bool explain = false;
    bool showInputs = false;
    bool hasMethod = false; ///< --method or --preset was typed
    game::MethodArguments method;
    gpu::DeviceOptions device;
};

/// Applies the options to a frame's settings.
core::Status change(const Arguments& arguments, MotionBlurSettings& settings) {
    game::MethodArguments wanted = arguments.method;
    if (!arguments.hasMethod)
        wanted.method = settings.method->name;
    const auto options = game::interpret(wanted);
    if (!options)
        return options.error();
    if (!options.value().method->blur)
        return makeError("--method {} is no filter that a dump could be for", wanted.method);
    if (arguments.hasMethod) {
        settings = options.value().motionBlur;
        return {};
    }
    if (wanted.samples)
        settings.sampleCount = *wanted.samples;
    for (const std::string& setting : wanted.settings)
        SHUTTER_TRY(game::applySetting(setting, *options.value().method, settings));
    return {};
}

int run(const Arguments& arguments) {
    ReplayOptions options;
    options.folder = arguments.folder;
    options.out = arguments.out;
    options.explains = arguments.explain;
    options.showsInputs = arguments.showInputs;
    options.change = [&](MotionBlurSettings& settings) { return change(arguments, settings); };
    std::istringstream names(arguments.aov);
    for (std::string name; std::getline(names, name, ',');)
        options.aovs.push_back(name);
    if (!options.aovs.empty() && options.out.empty())
        return game::fail(game::kExitUsage, makeError("--aov needs --out"));
    if (options.showsInputs && options.out.empty())
        return game::fail(game::kExitUsage, makeError("--show-inputs needs --out"));
    if (arguments.method.typed.contains("--budget"))
        return game::fail(game::kExitUsage, makeError("--budget is not for a replay"));
    // Without a method the options are for that of each frame.
    if (MotionBlurSettings any; arguments.hasMethod)
        if (const core::Status valid = change(arguments, any); !valid)
            return game::fail(game::kExitUsage, valid.error());
    if (!options.out.empty())
        if (const core::Status writable = io::checkWritable(options.out); !writable)
            return game::fail(game::kExitFailed, makeError("--out: {}", writable.error().message));
    auto device = gpu::Device::create(arguments.device);
    if (!device)
        return game::fail(game::kExitFailed, device.error());
    if (const core::Status done = replay(options, *device.value()); !done)
        return game::fail(game::kExitFailed, done.error());
    if (const uint32_t messages = device.value()->validationMessageCount(); messages > 0)
        return game::fail(
            game::kExitFailed, core::Error{core::countOf(messages, "Vulkan validation message")}
        );
    return game::kExitDone;
}

} // namespace

void addReplayCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command = app.add_subcommand(
        "replay", "draw the frames of a dump that a host of the motion blur wrote"
    );
    auto arguments = std::make_shared<Arguments>();
    command->add_option("folder", arguments->folder, "the dump")->required();
    command->add_option(
        "--out",
        arguments->out,
        "picture to write, .exr, .png or .jpg; numbered, at %04d if there is one, if there are more"
    );
    command->add_option(
        "--aov", arguments->aov, "intermediates to write next to --out, comma-separated, or all"
    );
    command->add_flag(
        "--explain", arguments->explain, "print what each frame is drawn from, and check its inputs"
    );
    command->add_flag(
        "--show-inputs",
        arguments->showInputs,
        "cover the pictures with panels of what the effect reads"
    );
    game::defineMethodOptions(*command, arguments->method);
    game::defineDeviceOptions(*command, arguments->device);
    command->callback([arguments, command, &exitStatus] {
        arguments->hasMethod = command->count("--method") > 0 || command->count("--preset") > 0;
        exitStatus = run(*arguments);
    });
}

} // namespace shutter::replay
