// SPDX-License-Identifier: MIT
// `--set NAME=VALUE`, and numbers as people type them.
#pragma once

#include "engine/core/result.h"
#include "game/shot/methods.h"
#include "modules/motion_blur/settings.h"

#include <optional>
#include <string>
#include <vector>

namespace shutter::game {

/// Times and exposures beyond it (32 years) have no meaning, and their sums must stay finite.
inline constexpr double kMaxSeconds = 1.0e9;

/// The parts between separators: one more than there are, empty ones too.
[[nodiscard]] std::vector<std::string> splitAt(const std::string& text, char separator);

/// Names are MotionBlurSettings' fields (motion_blur/setting_rows.h), and only those that the
/// method reads. Error: names what was typed wrongly, or the range that the value is not in.
[[nodiscard]] core::Status applySetting(
    const std::string& text, const MethodInfo& method, motion_blur::MotionBlurSettings& settings
);

} // namespace shutter::game
