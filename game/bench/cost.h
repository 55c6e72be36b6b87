// SPDX-License-Identifier: MIT
// A method's time in a measured picture.
#pragma once

#include "game/bench/journal.h"
#include "game/shot/methods.h"

namespace shutter::bench {

/// GPU milliseconds from the G-buffer to the linear picture.
[[nodiscard]] double computeFrameTime(const Sample& sample);

/// GPU milliseconds of the passes that the method adds to the sharp frame
/// (game/shot/pass_groups.h).
[[nodiscard]] double computeEffectTime(const game::MethodInfo& method, const Sample& sample);

} // namespace shutter::bench
