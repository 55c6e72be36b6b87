// SPDX-License-Identifier: MIT
// What operating systems do in ways of their own. Each has a source file, platform_<system>.cpp.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <cstdio>

namespace shutter::core {

/// Whether a person sees what is written to `stream`: it is a terminal.
[[nodiscard]] bool isTerminal(std::FILE* stream);

/// A number that no other running process has.
[[nodiscard]] uint64_t getProcessId();

/// Loads a shared library by the name that the system looks it up by. It is never unloaded. The
/// error is the system's own sentence.
[[nodiscard]] Result<void*> openLibrary(const char* name);

using FoundFunction = void (*)();

/// A function of a library that openLibrary() returned; null where it has none of the name.
[[nodiscard]] FoundFunction findFunction(void* library, const char* name);

} // namespace shutter::core
