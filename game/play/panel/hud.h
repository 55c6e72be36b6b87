// SPDX-License-Identifier: MIT
// What is always on the screen: score, frame rate, the cost of the blur, and which method is where.
#pragma once

#include "game/play/panel/panel.h"

namespace shutter::game {

/// Pixels that the lines at the right edge and at the bottom take, where no panel should lie.
struct HudSpace {
    float top = 0.0f;
    float bottom = 0.0f;
};

/// Declared behind all windows of the current ImGui context.
HudSpace drawHud(const PanelFacts& facts, const PlaySettings& settings);

/// "motion blur 12.3 ms (19 % of the frame)".
[[nodiscard]] std::string describeBlurCost(
    const std::string& method, const render::FrameStatistics& statistics, double frameMilliseconds
);

} // namespace shutter::game
