// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace shutter::io {

/// How names of temporary files begin; a process that was killed leaves them.
inline constexpr std::string_view kTemporaryPrefix = ".shutter-";

/// A name of its own for what will be renamed to `path`: in the same folder, so that the rename is
/// atomic; short, so that it fits where the name does.
[[nodiscard]] std::filesystem::path makeTemporaryPath(const std::filesystem::path& path);

/// The first `maxBytes` bytes of a regular file (all of it when it is shorter). An Error says in
/// one sentence that the path is missing, a folder, no regular file or not readable.
[[nodiscard]] core::Result<std::vector<uint8_t>>
readFileBytes(const std::filesystem::path& path, uint64_t maxBytes);

/// Writes a temporary file beside `path` and renames it, so that an interrupted write never leaves
/// half a file under this name. A pipe or a device is written to as it is, not replaced. An Error
/// names the file and why; then nothing is left behind.
[[nodiscard]] core::Status
writeFileBytes(const std::filesystem::path& path, std::span<const uint8_t> bytes);

/// The same for text.
[[nodiscard]] core::Status writeFileText(const std::filesystem::path& path, std::string_view text);

} // namespace shutter::io
