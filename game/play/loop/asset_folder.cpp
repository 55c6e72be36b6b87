// SPDX-License-Identifier: MIT
#include "game/play/loop/asset_folder.h"

#include <cstdlib>
#include <system_error>

namespace shutter::game {

std::filesystem::path findAssetFolder() {
    if (const char* named = std::getenv("SHUTTER_ASSETS"); named && *named)
        return named;
    std::error_code ignored;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
    const auto beside = program / "assets";
    if (std::filesystem::is_directory(beside, ignored))
        return beside;
    return (program.parent_path() / "share" / "shutter" / "assets").lexically_normal();
}

} // namespace shutter::game
