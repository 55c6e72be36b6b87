// SPDX-License-Identifier: MIT
// The parts of what a player sees: the head-up display, and the sections of the panel, each of
// which is drawn inside a header that unfolds.
#pragma once

#include "game/play/panel/panel.h"
#include "game/play/panel/pass_history.h"

#include <string_view>
#include <vector>

namespace shutter::game {

/// Names of MotionBlurSettings that the method reads, its count of samples too unless that is
/// PlaySettings::denoisedRays. Empty for methods outside modules/motion_blur.
[[nodiscard]] std::vector<std::string_view> listReadSettings(const MethodInfo& method);

void drawPlaySection(const PanelFacts& facts, PanelRequests& requests);
void drawMethodSection(const PanelFacts& facts, PlaySettings& settings);
/// Settings of the picture other than the blur, and its size. The other effects, each with its
/// switch.
void drawEffectSection(PlaySettings& settings);
void drawPictureSection(const PanelFacts& facts, PlaySettings& settings);
/// All settings of the blur: those that no shown method reads are greyed, below the others.
void drawSettingSection(const PanelFacts& facts, PlaySettings& settings);
void drawShutterSection(const PanelFacts& facts, PlaySettings& settings);
/// Depth of field: what replaces the camera's own lens.
void drawLensSection(const PanelFacts& facts, PlaySettings& settings, PanelRequests& requests);
void drawReducedMotionSection(PlaySettings& settings);
void drawTimeSection(const PassHistory& history, const PlaySettings& settings);
void drawReasonSection(const PanelFacts& facts);
/// All keys, those of the demo or scene first.
void drawKeySection(const PanelFacts& facts);

/// "photo mode: truth, 12 rays per pixel", "paused, view: depth", "speed 0.5"; empty: the game
/// runs.
[[nodiscard]] std::string describeState(const PanelFacts& facts, const std::string& view);

/// The keys that a new player needs, besides those of the demo or scene.
[[nodiscard]] std::span<const KeyHelp> listCommonKeys();

/// A part of the window, pixels.
struct HudRect {
    float left = 0.0f;
    float top = 0.0f;
    float right = 0.0f;
    float bottom = 0.0f;
};

struct HudSpace {
    /// Pixels that the lines at the right edge and at the bottom take, where no panel should lie.
    float top = 0.0f;
    float bottom = 0.0f;
    std::vector<HudRect> lines; ///< the grounds of all lines: in the window, and none meets another
};

/// Declared behind all windows of the current ImGui context. Where the window is too small for all
/// lines, they wrap and give way to one another, and those that find no room are left out.
HudSpace drawHud(const PanelFacts& facts, const PlaySettings& settings);

/// A line of text in the middle of the window, where there is no picture yet.
void drawNotice(const std::string& text);

/// Whether the budget made the blur of that frame give something up.
[[nodiscard]] bool isReduced(const render::FrameStatistics& statistics);

/// Whether another method drew that frame, as the pipelines of its own were still being made.
[[nodiscard]] bool isDrawnByStandIn(const render::FrameStatistics& statistics);

/// The method that drew a frame for `method`: that, a stand-in, or the one that a budget fell back
/// to. \param statistics of the method's last frame; null: none is finished yet
[[nodiscard]] std::string
findDrawnMethod(const std::string& method, const render::FrameStatistics* statistics);

/// "resolved"; "resolved, reduced: budget, F1" if a budget dropped quality, "own_velocity for
/// resolved: budget, F1" if it fell back to another method; "hybrid: gather until its pipelines are
/// made" where that method stood in for it.
/// \param statistics of the method's last frame; null: none is finished yet
/// \param isLimited there is a budget
[[nodiscard]] std::string describeMethod(
    const std::string& method, const render::FrameStatistics* statistics, bool isLimited
);

/// The enabled effects other than the blur, "taa, sky, bloom".
[[nodiscard]] std::string describeEffects(const PlaySettings& settings);

/// "motion blur 12.3 ms (19 % of the frame)"; without the share where frames overlap, so that the
/// blur's time exceeds that from one picture to the next.
[[nodiscard]] std::string describeBlurCost(
    const std::string& method, const render::FrameStatistics& statistics, double frameMilliseconds
);

} // namespace shutter::game
