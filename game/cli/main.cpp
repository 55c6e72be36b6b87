// SPDX-License-Identifier: MIT
#include "game/blur/blur_run.h"
#include "game/cli/commands.h"
#include "game/options/program.h"
#include "game/play/loop/play_options.h"
#include "game/replay/replay_run.h"

#include <CLI/CLI.hpp>

using namespace shutter;

int main(int argc, char** argv) {
    if (const auto exitStatus = game::runExternalCommand(argc, argv))
        return *exitStatus;
    CLI::App app("Shutter: accurate motion blur", "shutter");
    app.require_subcommand(1);
    int exitStatus = game::kExitDone;
    game::addRenderCommand(app, exitStatus);
    game::addCompareCommand(app, exitStatus);
    game::addInfoCommand(app, exitStatus);
    game::addPlayCommand(app, exitStatus);
    replay::addReplayCommand(app, exitStatus);
    blur::addBlurCommand(app, exitStatus);
    game::addExternalCommands(app);
    return game::runProgram(app, argc, argv, exitStatus);
}
