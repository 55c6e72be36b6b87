// SPDX-License-Identifier: MIT
// Names of files that a player makes by a key, one after another.
#pragma once

#include "engine/core/result.h"

#include <filesystem>
#include <span>
#include <string>

namespace shutter::game {

/// "folder/stem_001.png", or the first number after that of which there is no file.
/// \param taken files that will be there soon
/// Error: there are 999 already.
[[nodiscard]] core::Result<std::filesystem::path> findFreeFile(
    const std::filesystem::path& folder,
    const std::string& stem,
    const std::string& extension,
    std::span<const std::filesystem::path> taken = {}
);

} // namespace shutter::game
