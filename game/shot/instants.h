// SPDX-License-Identifier: MIT
// How many instants of a frame accumulate averages where the frame's own motion tells.
#pragma once

#include "engine/render/renderer.h"

#include <cstdint>
#include <string>

namespace shutter::game {

struct InstantChoice {
    uint32_t count = 1;
    double stepPx = 0.0; ///< longest way between two instants
    std::string reason;  ///< a clause
};

/// Instants of a frame in which a light moves, at least: that moves no point, but shading changes.
inline constexpr uint32_t kLeastInstantsOfLight = 16;

/// As few as keep the step, 1 where nothing moves.
/// \param maxStepPx above 0
/// \param most above 0; where it is not enough, the step is longer
[[nodiscard]] InstantChoice
chooseInstants(const render::LongestPath& path, double maxStepPx, uint32_t most);

} // namespace shutter::game
