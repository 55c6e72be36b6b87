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

/// Where this user's settings belong (the same); empty where nowhere.
[[nodiscard]] inline std::filesystem::path findSettingsFile() {
    const std::filesystem::path file = std::filesystem::path("shutter") / "settings.json";
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config && *config)
        return config / file;
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::filesystem::path(home) / ".config" / file;
    return {};
}

} // namespace shutter::game
