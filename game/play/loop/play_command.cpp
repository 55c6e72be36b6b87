// SPDX-License-Identifier: MIT
#include "game/options/program.h"
#include "game/play/loop/play_loop.h"

#include <CLI/CLI.hpp>

#include <memory>

namespace shutter::game {

namespace {

int runPlay(const PlayArguments& arguments) {
    auto options = interpret(arguments);
    if (!options)
        return fail(kExitUsage, options.error());
    if (core::Status known = checkStage(options.value()); !known)
        return fail(kExitFailed, known.error());
    auto loop = PlayLoop::open(options.value());
    if (!loop)
        return fail(kExitFailed, loop.error());
    if (core::Status done = loop.value()->run(); !done)
        return fail(kExitFailed, done.error());
    return kExitDone;
}

} // namespace

void addPlayCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command = app.add_subcommand("play", "a window: demos, scenes, the effect's toggle");
    auto arguments = std::make_shared<PlayArguments>();
    definePlayOptions(*command, *arguments);
    command->callback([arguments, &exitStatus] { exitStatus = runPlay(*arguments); });
}

} // namespace shutter::game
