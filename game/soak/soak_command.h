// SPDX-License-Identifier: MIT
#pragma once

namespace CLI {
class App;
}

namespace shutter::soak {

/// Adds `shutter soak`, which leaves its exit status (game/options/program.h).
void addSoakCommand(CLI::App& app, int& exitStatus);

} // namespace shutter::soak
