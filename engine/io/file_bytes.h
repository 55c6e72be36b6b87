// SPDX-License-Identifier: MIT
// Whole files: read, written whole or not at all, and hashed.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::io {

/// A unique name for a file that will be renamed to `path`: in the same folder, so that the rename
/// is atomic; short, so that it is allowed wherever the final name is.
[[nodiscard]] std::filesystem::path makeTemporaryPath(const std::filesystem::path& path);

/// Removes the temporary files in a folder that killed processes left, and those of running ones.
void removeTemporaryFiles(const std::filesystem::path& folder);

/// The first `maxBytes` bytes of a regular file (all of it when it is shorter). An Error says in
/// one sentence that the path is missing, a folder, not a regular file or not readable.
[[nodiscard]] core::Result<std::vector<uint8_t>>
readFileBytes(const std::filesystem::path& path, uint64_t maxBytes);

/// Writes a temporary file beside `path` and renames it, so that an interrupted write never leaves
/// half a file under this name. A pipe or a device is written to as it is, not replaced. An Error
/// names the file and why; then nothing is left behind.
[[nodiscard]] core::Status
writeFileBytes(const std::filesystem::path& path, std::span<const uint8_t> bytes);

/// The same for text.
[[nodiscard]] core::Status writeFileText(const std::filesystem::path& path, std::string_view text);

/// 32 hexadecimal digits that identify contents, to find again what was computed from them; not for
/// security. FarmHash Fingerprint128: the same on every machine.
[[nodiscard]] std::string computeContentHash(std::string_view bytes);

/// computeContentHash() of a file's bytes. Error: the file cannot be read; names it.
[[nodiscard]] core::Result<std::string> computeFileHash(const std::filesystem::path& path);

} // namespace shutter::io
