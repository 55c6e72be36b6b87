// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace shutter::io {

/// The first `maxBytes` bytes of a regular file (all of it when it is shorter). An Error says in
/// one sentence that the path is missing, a folder, no regular file or not readable.
[[nodiscard]] core::Result<std::vector<uint8_t>>
readFileBytes(const std::filesystem::path& path, uint64_t maxBytes);

} // namespace shutter::io
