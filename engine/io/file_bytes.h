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

/// The first `maxBytes` bytes of a regular file (all of it when it is shorter). Error: one
/// sentence: the path is missing, a folder, not a regular file or not readable.
[[nodiscard]] core::Result<std::vector<uint8_t>>
readFileBytes(const std::filesystem::path& path, uint64_t maxBytes);

/// Whole or not at all: core::writeWholeFile(). Error: names the file and why.
[[nodiscard]] core::Status
writeFileBytes(const std::filesystem::path& path, std::span<const uint8_t> bytes);

/// The same for text.
[[nodiscard]] core::Status writeFileText(const std::filesystem::path& path, std::string_view text);

/// 32 hexadecimal digits that identify contents, as a cache key; not for security. FarmHash
/// Fingerprint128: the same on every machine.
[[nodiscard]] std::string computeContentHash(std::string_view bytes);

/// computeContentHash() of a file's bytes. Error: the file cannot be read; names it.
[[nodiscard]] core::Result<std::string> computeFileHash(const std::filesystem::path& path);

} // namespace shutter::io
