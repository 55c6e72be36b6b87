// SPDX-License-Identifier: MIT
// Short names for contents, to find again what was computed from them. Not for security.
#pragma once

#include "engine/core/result.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace shutter::io {

/// 32 hexadecimal digits of the bytes (FarmHash Fingerprint128: the same on every machine).
[[nodiscard]] std::string computeContentHash(std::string_view bytes);

/// The same of a file's bytes. Error: it cannot be read; names it.
[[nodiscard]] core::Result<std::string> computeFileHash(const std::filesystem::path& path);

} // namespace shutter::io
