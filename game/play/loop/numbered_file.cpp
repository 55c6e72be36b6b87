// SPDX-License-Identifier: MIT
#include "game/play/loop/numbered_file.h"

#include <algorithm>
#include <system_error>

namespace shutter::game {

namespace {

constexpr int kMaxFiles = 999;

} // namespace

core::Result<std::filesystem::path> findFreeFile(
    const std::filesystem::path& folder,
    const std::string& stem,
    const std::string& extension,
    std::span<const std::filesystem::path> taken
) {
    std::error_code ignored;
    for (int i = 1; i <= kMaxFiles; ++i) {
        std::filesystem::path file = folder / fmt::format("{}_{:03}{}", stem, i, extension);
        const bool isTaken = std::find(taken.begin(), taken.end(), file) != taken.end();
        if (!isTaken && !std::filesystem::exists(file, ignored))
            return file;
    }
    return core::makeError(
        "{} holds {} files {}_NNN{} already", folder.string(), kMaxFiles, stem, extension
    );
}

} // namespace shutter::game
