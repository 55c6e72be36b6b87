// SPDX-License-Identifier: MIT
// The subcommands. Each adds itself to the command line and, when chosen, leaves its exit status:
// 0 done, 1 failed (one sentence was printed), 2 wrong usage.
#pragma once

namespace CLI {
class App;
}

namespace shutter::game {

void addRenderCommand(CLI::App& app, int& exitStatus);
void addInfoCommand(CLI::App& app, int& exitStatus);

} // namespace shutter::game
