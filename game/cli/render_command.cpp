// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gpu/device.h"
#include "game/cli/commands.h"
#include "game/options/program.h"
#include "game/options/render_arguments.h"
#include "game/output/sequence.h"
#include "game/output/sequence_journal.h"

#include <CLI/CLI.hpp>

#include <memory>
#include <optional>
#include <utility>

namespace shutter::game {

namespace {

/// Prints the plan for a script that distributes the frames over several processes.
core::Status printPlan(RenderOptions& options) {
    auto shot = loadShot(options.shot);
    if (!shot)
        return shot.error();
    SHUTTER_TRY(planClipFrames(shot.value().world, options.shot));
    fmt::print("frames: {}\n", options.shot.frameTimes.size());
    if (!options.shot.isSequence)
        return {};
    std::filesystem::path journal = journalFile(options.output.out);
    fmt::print("journal: {}\n", journal.string());
    const std::filesystem::path& film = options.output.film;
    fmt::print(
        "work: {}\n",
        film.empty() ? journal.replace_extension(".parts").string() : film.string() + ".parts"
    );
    return {};
}

int runRender(const RenderArguments& arguments) {
    auto options = interpret(arguments);
    if (!options)
        return fail(kExitUsage, options.error());
    if (core::Status loaded = loadFlythrough(arguments.shot, options.value().shot); !loaded)
        return fail(kExitFailed, loaded.error());
    if (core::Status writable = checkOutputs(options.value()); !writable)
        return fail(kExitFailed, writable.error());
    std::optional<io::VideoEncoder> encoder;
    if (!options.value().output.film.empty()) {
        auto found = prepareFilm(options.value());
        if (!found)
            return fail(kExitFailed, found.error());
        encoder = std::move(found).value();
    }
    if (options.value().output.dryRun) {
        const core::Status planned = printPlan(options.value());
        return planned ? kExitDone : fail(kExitFailed, planned.error());
    }
    gpu::DeviceOptions deviceOptions = options.value().device;
    deviceOptions.cacheFolder = findCacheFolder();
    auto device = gpu::Device::create(deviceOptions);
    if (!device)
        return fail(kExitFailed, device.error());
    if (core::Status done = renderSequence(options.value(), encoder, *device.value()); !done)
        return fail(kExitFailed, done.error());
    if (const uint32_t messages = device.value()->validationMessageCount(); messages > 0)
        return fail(kExitFailed, core::Error{core::countOf(messages, "Vulkan validation message")});
    return kExitDone;
}

} // namespace

void addRenderCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command = app.add_subcommand("render", "render frames without a window");
    auto arguments = std::make_shared<RenderArguments>();
    defineRenderOptions(*command, *arguments);
    command->callback([arguments, &exitStatus] { exitStatus = runRender(*arguments); });
}

} // namespace shutter::game
