// SPDX-License-Identifier: MIT
// The program of a build for hosts (SHUTTER_EMBEDDING_TOOLS): replays and compares their dumps.
#include "game/cli/commands.h"
#include "game/options/program.h"
#include "game/replay/replay_run.h"

#include <CLI/CLI.hpp>

using namespace shutter;

int main(int argc, char** argv) {
    CLI::App app("Shutter: accurate motion blur", "shutter");
    app.require_subcommand(1);
    int exitStatus = game::kExitDone;
    replay::addReplayCommand(app, exitStatus);
    game::addCompareCommand(app, exitStatus);
    return game::runProgram(app, argc, argv, exitStatus);
}
