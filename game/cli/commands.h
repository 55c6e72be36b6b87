// SPDX-License-Identifier: MIT
// The subcommands. Each adds itself to the command line and, when chosen, leaves its exit status:
// 0 done, 1 failed (one sentence was printed), 2 wrong usage.
#pragma once

#include <optional>

namespace CLI {
class App;
}

namespace shutter::game {

void addRenderCommand(CLI::App& app, int& exitStatus);
void addInfoCommand(CLI::App& app, int& exitStatus);

/// How far two pictures are apart.
void addCompareCommand(CLI::App& app, int& exitStatus);

/// Lists in `--help` the commands that are separate programs, so that users who only render need
/// not build them.
void addExternalCommands(CLI::App& app);

/// Becomes the program of the external command that the command line names first; returns only
/// where it cannot.
/// \return the exit status, a sentence printed; nothing: no external command is named
[[nodiscard]] std::optional<int> runExternalCommand(int argc, char** argv);

} // namespace shutter::game
