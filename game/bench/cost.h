// SPDX-License-Identifier: MIT
// What of a picture's passes counts as a method's time.
#pragma once

#include "game/bench/journal.h"
#include "game/methods.h"

#include <string_view>

namespace shutter::bench {

/// False for what every method does alike after the linear picture is there: tone map, read-back.
[[nodiscard]] bool isCounted(std::string_view pass);

/// True for what a method adds to the sharp frame. A method that draws the scene in its own way
/// (many frames, rays alone) adds all it does; `sharp` adds nothing.
[[nodiscard]] bool isEffect(const game::MethodInfo& method, std::string_view pass);

/// GPU milliseconds from the G-buffer to the linear picture.
[[nodiscard]] double computeFrameTime(const Sample& sample);

/// GPU milliseconds of the passes that the method adds.
[[nodiscard]] double computeEffectTime(const game::MethodInfo& method, const Sample& sample);

} // namespace shutter::bench
