// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace shutter::motion_blur {

/// Writes a temporary file beside `path` and renames it, so that no half file is left under this
/// name. Error: names the file and why; then nothing is left behind.
[[nodiscard]] core::Status
writeDumpFile(const std::filesystem::path& path, std::span<const std::byte> bytes);

} // namespace shutter::motion_blur
