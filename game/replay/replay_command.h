// SPDX-License-Identifier: MIT
#pragma once

namespace CLI {
class App;
}

namespace shutter::replay {

/// Adds `shutter replay`, which leaves its exit status (game/options/program.h).
void addReplayCommand(CLI::App& app, int& exitStatus);

} // namespace shutter::replay
