// SPDX-License-Identifier: MIT
// Parts of the panel, each the inside of a header that unfolds.
#pragma once

#include "game/play/panel/panel.h"
#include "game/play/panel/pass_history.h"

#include <string_view>
#include <vector>

namespace shutter::game {

/// Names of MotionBlurSettings that the method reads, its count of samples too unless that is
/// PlaySettings::denoisedRays. Empty for what is no method of modules/motion_blur.
[[nodiscard]] std::vector<std::string_view> listReadSettings(const MethodInfo& method);

void drawPlaySection(const PanelFacts& facts, PlaySettings& settings, PanelWishes& wishes);
void drawMethodSection(const PanelFacts& facts, PlaySettings& settings);
/// All settings of the blur: those that no shown method reads are greyed, below the others.
void drawSettingSection(PlaySettings& settings);
void drawShutterSection(const PanelFacts& facts, PlaySettings& settings);
void drawReducedMotionSection(PlaySettings& settings);
void drawTimeSection(const PassHistory& history, const PlaySettings& settings);
void drawReasonSection(const PanelFacts& facts);

} // namespace shutter::game
