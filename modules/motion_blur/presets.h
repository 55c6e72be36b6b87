// SPDX-License-Identifier: MIT
// A method and its settings by one word, for people who want no more.
#pragma once

#include "engine/core/result.h"
#include "modules/motion_blur/settings.h"

#include <span>
#include <string_view>

namespace shutter::motion_blur {

struct Preset {
    const char* name;            ///< "off", "performance", "balanced", "quality", "paper"
    const char* description;     ///< one line
    bool isOff;                  ///< no blur: the settings do not count
    MotionBlurSettings settings; ///< performance and balanced need no rays, the others do
};

/// In order of rising quality; the paper's comes last.
[[nodiscard]] std::span<const Preset> listPresets();

/// Error: lists the names of all presets.
[[nodiscard]] core::Result<const Preset*> findPreset(std::string_view name);

} // namespace shutter::motion_blur
