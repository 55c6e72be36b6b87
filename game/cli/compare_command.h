// SPDX-License-Identifier: MIT
// `shutter compare`: how far two pictures are apart.
#pragma once

namespace CLI {
class App;
}

namespace shutter::game {

/// As the subcommands of commands.h.
void addCompareCommand(CLI::App& app, int& exitStatus);

} // namespace shutter::game
