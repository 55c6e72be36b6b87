// SPDX-License-Identifier: MIT
#include "engine/gpu/device.h"
#include "game/cli/commands.h"
#include "game/options/error_output.h"
#include "game/options/render_options.h"
#include "game/options/user_folders.h"
#include "game/output/film.h"
#include "game/output/sequence.h"
#include "game/shot/flight.h"

#include <CLI/CLI.hpp>

#include <memory>
#include <optional>
#include <utility>

namespace shutter::game {

namespace {

int fail(int status, const core::Error& error) {
    printError(error);
    return status;
}

int runRender(const RenderArguments& arguments) {
    auto options = interpret(arguments);
    if (!options)
        return fail(kExitUsage, options.error());
    if (core::Status loaded = loadFlythrough(arguments, options.value()); !loaded)
        return fail(kExitFailed, loaded.error());
    if (core::Status writable = checkOutputs(options.value()); !writable)
        return fail(kExitFailed, writable.error());
    std::optional<io::VideoEncoder> encoder;
    if (!options.value().film.empty()) {
        auto found = prepareFilm(options.value());
        if (!found)
            return fail(kExitFailed, found.error());
        encoder = std::move(found).value();
    }
    gpu::DeviceOptions deviceOptions;
    deviceOptions.wanted = options.value().device;
    deviceOptions.validate = options.value().validate;
    deviceOptions.bestTier = options.value().bestTier;
    deviceOptions.cacheFolder = findCacheFolder();
    auto device = gpu::Device::create(deviceOptions);
    if (!device)
        return fail(kExitFailed, device.error());
    if (core::Status done = renderSequence(options.value(), encoder, *device.value()); !done)
        return fail(kExitFailed, done.error());
    if (const uint32_t messages = device.value()->validationMessageCount(); messages > 0)
        return fail(kExitFailed, core::makeError("{} Vulkan validation messages", messages));
    return kExitDone;
}

} // namespace

void addRenderCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command = app.add_subcommand("render", "render frames without a window");
    auto arguments = std::make_shared<RenderArguments>();
    defineRenderOptions(*command, *arguments);
    command->callback([command, arguments, &exitStatus] {
        arguments->isFpsTyped = command->count("--fps") > 0;
        arguments->pictureOptions = describePictureOptions(*command);
        exitStatus = runRender(*arguments);
    });
}

} // namespace shutter::game
