// SPDX-License-Identifier: MIT
// The program's environment, the same for all commands: messages and exit statuses, the user's
// folders, and the folders of installed files.
#pragma once

#include "engine/core/result.h"

#include <filesystem>
#include <string>

namespace CLI {
class App;
}

namespace shutter::game {

/// `text` on one line without control characters: names from files and arguments are printed as
/// they are, and one with a line break or an escape sequence must not reach the terminal as such.
[[nodiscard]] std::string toOneLine(std::string text);

/// "shutter: <sentence>" on stderr, always one line.
void printError(const core::Error& error);

/// Exit statuses.
inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1; ///< one sentence was printed
inline constexpr int kExitUsage = 2;  ///< the command line was wrong

/// Prints the error and returns `status`.
[[nodiscard]] int fail(int status, const core::Error& error);

/// Returns `status`, or kExitFailed with a sentence where something printed to stdout was lost.
[[nodiscard]] int finishOutput(int status);

/// Parses the command line, runs its command, and adds the option -v.
/// \param exitStatus set by the commands of `app`
/// \return the program's exit status: kExitUsage with a sentence if the command line is wrong,
///         kExitFailed with one where the device, the memory or the output fails
[[nodiscard]] int runProgram(CLI::App& app, int argc, char** argv, int& exitStatus);

/// The user's cache folder for this program: XDG_CACHE_HOME/shutter, else ~/.cache/shutter (XDG
/// base directory specification). Empty if neither variable is set.
[[nodiscard]] std::filesystem::path findCacheFolder();

/// The user's settings file: XDG_CONFIG_HOME/shutter/settings.json, else
/// ~/.config/shutter/settings.json. Empty if neither variable is set. The file need not exist.
[[nodiscard]] std::filesystem::path findSettingsFile();

/// The folder of the scenes that come with the program: SHUTTER_ASSETS if it is set, else `assets`
/// in the program's folder (a build), else ../share/shutter/assets (an installation).
[[nodiscard]] std::filesystem::path findAssetFolder();

} // namespace shutter::game
