// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"

#include <string>

namespace shutter::game {

/// `text` on one line without control characters: names from files and arguments are printed as
/// they are, and one with a line break or an escape sequence must not reach the terminal as such.
[[nodiscard]] std::string toOneLine(std::string text);

/// "shutter: <sentence>" on stderr, always one line.
void printError(const core::Error& error);

/// What the program returns.
inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1; ///< one sentence was printed
inline constexpr int kExitUsage = 2;  ///< the command line was wrong

/// Prints the error and returns `status`.
[[nodiscard]] int fail(int status, const core::Error& error);

} // namespace shutter::game
