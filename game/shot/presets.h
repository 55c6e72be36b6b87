// SPDX-License-Identifier: MIT
// Named choices of a method and of the blur's settings, for people who want no more than one word.
#pragma once

#include "engine/core/result.h"
#include "modules/motion_blur/settings.h"

#include <span>
#include <string_view>

namespace shutter::game {

struct Preset {
    const char* name;                     ///< "off", "performance", "balanced", "quality", "paper"
    const char* description;              ///< one line
    const char* method;                   ///< of listMethods()
    motion_blur::MotionBlurSettings blur; ///< unused where the method is sharp; its method too
};

/// In order of rising quality; the paper's comes last. game/play/README.md says what each costs.
[[nodiscard]] std::span<const Preset> listPresets();

/// Error: lists the names of all presets.
[[nodiscard]] core::Result<const Preset*> findPreset(std::string_view name);

} // namespace shutter::game
