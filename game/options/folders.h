// SPDX-License-Identifier: MIT
// Where the program finds what it keeps for a user and what is installed with it.
#pragma once

#include <filesystem>

namespace shutter::game {

/// The user's cache folder for this program: XDG_CACHE_HOME/shutter, else ~/.cache/shutter (XDG
/// base directory specification). Empty if neither variable is set.
[[nodiscard]] std::filesystem::path findCacheFolder();

/// The user's settings file: XDG_CONFIG_HOME/shutter/settings.json, else
/// ~/.config/shutter/settings.json. Empty if neither variable is set. The file need not exist.
[[nodiscard]] std::filesystem::path findSettingsFile();

/// The folder of the scenes that come with the program: SHUTTER_ASSETS if it is set, else `assets`
/// beside the program (a build), else ../share/shutter/assets (an installation).
[[nodiscard]] std::filesystem::path findAssetFolder();

} // namespace shutter::game
