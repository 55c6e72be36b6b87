// SPDX-License-Identifier: MIT
// Rows of what a player sets beside the blur's own settings (motion_blur/setting_rows.h).
#pragma once

#include "engine/core/setting_row.h"
#include "game/play/panel/play_settings.h"
#include "modules/motion_blur/setting_rows.h"

#include <span>

namespace shutter::game {

/// Longest name of an intermediate, bytes.
inline constexpr size_t kMaxViewBytes = 64;

/// But method, leftMethod and view, which are names, and what has rows of its own.
[[nodiscard]] std::span<const core::SettingRow<PlaySettings>> listPlayRows();
[[nodiscard]] std::span<const core::SettingRow<motion_blur::BlurBudget>> listBudgetRows();
[[nodiscard]] std::span<const core::SettingRow<scene::CameraShutter>> listShutterRows();
/// But the samples.
[[nodiscard]] std::span<const core::SettingRow<scene::ShutterResponse>> listResponseRows();
[[nodiscard]] std::span<const core::SettingRow<scene::CutDetection>> listCutRows();

} // namespace shutter::game
