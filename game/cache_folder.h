// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <filesystem>

namespace shutter::game {

/// Where this user's caches belong (XDG base directory specification); empty where nowhere.
[[nodiscard]] inline std::filesystem::path findCacheFolder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
        return std::filesystem::path(cache) / "shutter";
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::filesystem::path(home) / ".cache" / "shutter";
    return {};
}

} // namespace shutter::game
