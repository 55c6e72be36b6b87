// SPDX-License-Identifier: MIT
// `shutter bench`.
#include "game/bench/bench_run.h"
#include "game/options/program.h"

#include <CLI/CLI.hpp>

using namespace shutter;

int main(int argc, char** argv) {
    CLI::App app("What accuracy costs in time", "shutter bench");
    int exitStatus = game::kExitDone;
    bench::defineBench(app, exitStatus);
    return game::runProgram(app, argc, argv, exitStatus);
}
