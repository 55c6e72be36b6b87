// SPDX-License-Identifier: MIT
// `--set NAME=VALUE`, and numbers as people type them.
#pragma once

#include "engine/core/result.h"
#include "game/methods.h"
#include "modules/motion_blur/settings.h"

#include <optional>
#include <string>

namespace shutter::game {

/// A whole string as a finite number.
[[nodiscard]] std::optional<double> parseNumber(const std::string& text);

/// Names are MotionBlurSettings' fields, and only those that the method reads. A value's range is
/// not checked: motion_blur::validate does. Error: names what was typed wrongly.
[[nodiscard]] core::Status applySetting(
    const std::string& text, const MethodInfo& method, motion_blur::MotionBlurSettings& settings
);

} // namespace shutter::game
