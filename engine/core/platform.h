// SPDX-License-Identifier: MIT
// Functions that differ between operating systems. Each has a source file, platform_<system>.cpp.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>

namespace shutter::core {

/// Whether `stream` is a terminal.
[[nodiscard]] bool isTerminal(std::FILE* stream);

/// Returns this process's id, unique among running processes.
[[nodiscard]] uint64_t getProcessId();

/// Why this process may not write to a file or a device, or add files to a folder; 0: it may.
[[nodiscard]] std::error_code testWriting(const std::filesystem::path& path);

/// Gives a file the owner and the group of another, or one of the two, as far as we may.
void copyOwner(const std::filesystem::path& from, const std::filesystem::path& to);

/// The file descriptor of this process that the path names, as /dev/fd/1 does. A link to such a
/// path is none.
[[nodiscard]] std::optional<int> findOwnDescriptor(const std::filesystem::path& path);

/// Opens a stream that writes at the descriptor's position. Returns null and sets errno if the
/// descriptor is closed.
[[nodiscard]] std::FILE* openDescriptor(int descriptor);

/// Loads a shared library by its system name. It is never unloaded. Error: the system's message.
[[nodiscard]] Result<void*> openLibrary(const char* name);

using FoundFunction = void (*)();

/// A function of a library that openLibrary() returned; null where it has none of the name.
[[nodiscard]] FoundFunction findFunction(void* library, const char* name);

} // namespace shutter::core
