// SPDX-License-Identifier: MIT
#include "game/play/panel/panel_sections.h"
#include "game/shot/methods.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>

namespace shutter::game {

namespace {

constexpr const char* kKeys[] = {
    "M method",
    "N left method",
    "X split",
    "V view",
    "1-5 presets",
    "B reduced motion",
    "P pause",
    "T photo",
    ". step",
    ", slower",
    "/ faster",
    "C camera",
    "R record",
    "F1 panel",
    "F2 save picture",
    "F5 save",
    "F9 load",
    "F11 full screen",
    "Esc quit",
};

/// One line; where the window is too narrow for it, lines that end between keys.
const std::string& describeKeys() {
    static const std::string kHelp = [] {
        std::string help;
        for (const char* key : kKeys) {
            help += help.empty() ? "" : "  ";
            for (const char c : std::string_view(key))
                help += c == ' ' ? "\xc2\xa0" : std::string(1, c); // a space that holds together
        }
        return help;
    }();
    return kHelp;
}

constexpr ImU32 kText = IM_COL32(245, 245, 245, 255);
constexpr ImU32 kEmphasis = IM_COL32(255, 221, 120, 255);
constexpr ImU32 kBack = IM_COL32(0, 0, 0, 150);

/// Lines of text, one below the other, each on a dark ground that any picture can lie behind.
class TextColumn {
  public:
    /// \param place upper corner \param share of a line's width that lies left of the place
    TextColumn(const ImVec2& place, float share) : mPlace(place), mShare(share) {}

    void add(const std::string& text, ImU32 color = kText, bool large = false) {
        ImFont* font = ImGui::GetIO().Fonts->Fonts[large ? 1 : 0];
        ImVec2 size = font->CalcTextSizeA(font->FontSize, FLT_MAX, mWrap, text.c_str());
        const float pad = padding();
        const ImVec2 from{std::floor(mPlace.x - mShare * size.x), std::floor(mPlace.y)};
        ImDrawList& list = *ImGui::GetBackgroundDrawList();
        list.AddRectFilled(
            {from.x - pad, from.y - pad}, {from.x + size.x + pad, from.y + size.y + pad}, kBack
        );
        list.AddText(font, font->FontSize, from, color, text.c_str(), nullptr, mWrap);
        mPlace.y += size.y + 2.0f * pad;
    }

    void setWrap(float width) { mWrap = width; }

    [[nodiscard]] float y() const { return mPlace.y; }

    static float padding() { return std::floor(0.2f * ImGui::GetFontSize()); }

  private:
    ImVec2 mPlace;
    float mShare;
    float mWrap = 0.0f; ///< pixels; 0: lines are as long as they are
};

void drawGame(const PanelFacts& facts, float margin) {
    TextColumn column({margin, margin}, 0.0f);
    for (const HudLine& line : facts.hud)
        column.add(line.text, line.emphasis ? kEmphasis : kText, line.emphasis);
    std::string state;
    if (facts.photoRays)
        state = fmt::format("photo mode: truth, {} rays per pixel", *facts.photoRays);
    else if (facts.paused)
        state = "paused";
    else if (facts.speed != 1.0)
        state = fmt::format("speed {:g}", facts.speed);
    if (facts.recording)
        state += fmt::format("{}recording", state.empty() ? "" : ", ");
    if (!state.empty())
        column.add(state, kEmphasis);
}

float drawRates(const PanelFacts& facts, const PlaySettings& settings, float margin) {
    TextColumn column({ImGui::GetIO().DisplaySize.x - margin, margin}, 1.0f);
    const double milliseconds = facts.frameMilliseconds;
    if (milliseconds > 0.0 && std::isfinite(milliseconds))
        column.add(fmt::format("{:.1f} fps   {:.1f} ms", 1000.0 / milliseconds, milliseconds));
    if (facts.left && settings.split)
        column.add("left: " + describeBlurCost(settings.leftMethod, *facts.left, milliseconds));
    if (facts.right)
        column.add(
            (facts.left && settings.split ? "right: " : "") +
            describeBlurCost(
                facts.photoRays ? "truth" : settings.method, *facts.right, milliseconds
            )
        );
    return column.y();
}

void drawSides(const PanelFacts& facts, const PlaySettings& settings, float y) {
    const float gap = ImGui::GetFontSize();
    const float width = ImGui::GetIO().DisplaySize.x;
    const float divider = std::floor(width * static_cast<float>(settings.dividerShare));
    if (facts.photoRays || !settings.split) {
        TextColumn({gap, y}, 0.0f).add(facts.photoRays ? "truth" : settings.method);
        return;
    }
    TextColumn({divider - gap, y}, 1.0f).add(settings.leftMethod);
    TextColumn({divider + gap, y}, 0.0f).add(settings.method);
}

} // namespace

std::string describeBlurCost(
    const std::string& method, const render::FrameStatistics& statistics, double frameMilliseconds
) {
    const auto info = findMethod(method);
    const double blur = info ? sumBlurMilliseconds(*info.value(), statistics) : 0.0;
    std::string text = fmt::format("motion blur {:.1f} ms", blur);
    if (frameMilliseconds > 0.0 && std::isfinite(frameMilliseconds))
        text += fmt::format(" ({:.0f} % of the frame)", 100.0 * blur / frameMilliseconds);
    return text;
}

HudSpace drawHud(const PanelFacts& facts, const PlaySettings& settings) {
    const float line = ImGui::GetFontSize() + 2.0f * TextColumn::padding();
    const float margin = std::floor(0.6f * ImGui::GetFontSize());
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    HudSpace space;
    drawGame(facts, margin);
    space.top = drawRates(facts, settings, margin) + margin;
    float y = window.y - margin;
    if (settings.showPanel) {
        const float wrap = std::max(window.x - 2.0f * margin, 1.0f);
        y -= ImGui::CalcTextSize(describeKeys().c_str(), nullptr, false, wrap).y;
        TextColumn help({margin, y}, 0.0f);
        help.setWrap(wrap);
        help.add(describeKeys());
        y -= margin;
    }
    if (!facts.message.empty()) {
        const float wrap = std::max(window.x - 2.0f * margin, 1.0f);
        y -= ImGui::CalcTextSize(facts.message.c_str(), nullptr, false, wrap).y;
        TextColumn message({margin, y}, 0.0f);
        message.setWrap(wrap);
        message.add(facts.message, kEmphasis);
        y -= margin;
    }
    y -= line;
    drawSides(facts, settings, y);
    space.bottom = window.y - y + margin;
    return space;
}

} // namespace shutter::game
