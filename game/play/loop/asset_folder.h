// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace shutter::game {

/// Where the scenes that come with the program are: SHUTTER_ASSETS where it is set, else `assets`
/// beside the program (a build), else ../share/shutter/assets (an installation).
[[nodiscard]] std::filesystem::path findAssetFolder();

} // namespace shutter::game
