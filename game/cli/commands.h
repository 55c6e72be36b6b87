// SPDX-License-Identifier: MIT
// The subcommands. Each adds itself to the command line and, when chosen, leaves its exit status:
// 0 done, 1 failed (one sentence was printed), 2 wrong usage.
#pragma once

namespace CLI {
class App;
}

namespace shutter::game {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;
inline constexpr int kExitUsage = 2;

void addRenderCommand(CLI::App& app, int& exitStatus);
void addCompareCommand(CLI::App& app, int& exitStatus);
void addInfoCommand(CLI::App& app, int& exitStatus);
void addBenchCommand(CLI::App& app, int& exitStatus); ///< game/bench
void addPlayCommand(CLI::App& app, int& exitStatus);  ///< game/play

} // namespace shutter::game
