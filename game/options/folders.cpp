// SPDX-License-Identifier: MIT
#include "game/options/folders.h"

#include <cstdlib>
#include <system_error>

namespace shutter::game {

namespace fs = std::filesystem;

fs::path findCacheFolder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
        return fs::path(cache) / "shutter";
    if (const char* home = std::getenv("HOME"); home && *home)
        return fs::path(home) / ".cache" / "shutter";
    return {};
}

fs::path findSettingsFile() {
    const fs::path file = fs::path("shutter") / "settings.json";
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config && *config)
        return config / file;
    if (const char* home = std::getenv("HOME"); home && *home)
        return fs::path(home) / ".config" / file;
    return {};
}

fs::path findAssetFolder() {
    if (const char* named = std::getenv("SHUTTER_ASSETS"); named && *named)
        return named;
    std::error_code ignored;
    const auto program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    const auto beside = program / "assets";
    if (fs::is_directory(beside, ignored))
        return beside;
    return (program.parent_path() / "share" / "shutter" / "assets").lexically_normal();
}

} // namespace shutter::game
