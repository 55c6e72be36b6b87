// SPDX-License-Identifier: MIT
// Commands that are programs of their own, beside this one: who asks for one picture need not build
// them.
#pragma once

#include <optional>

namespace CLI {
class App;
}

namespace shutter::game {

/// Lists them in `--help`.
void addExternalCommands(CLI::App& app);

/// Becomes the program of the external command that the command line names first; returns only
/// where it cannot.
/// \return the exit status, a sentence printed; nothing: no external command is named
[[nodiscard]] std::optional<int> runExternalCommand(int argc, char** argv);

} // namespace shutter::game
