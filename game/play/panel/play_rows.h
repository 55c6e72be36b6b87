// SPDX-License-Identifier: MIT
// Rows of what a player sets besides the blur, its budget (motion_blur/setting_rows.h) and the
// shutter (engine/scene/shutter.h).
#pragma once

#include "engine/core/setting_row.h"
#include "game/play/panel/play_settings.h"

#include <cstddef>

namespace shutter::game {

/// Longest name of an intermediate, bytes.
inline constexpr size_t kMaxViewBytes = 64;

/// One row per field of PlaySettings, except for names (method, leftMethod, view) and for structs
/// that have rows of their own.
[[nodiscard]] core::SettingRows<PlaySettings> listPlayRows();

} // namespace shutter::game
