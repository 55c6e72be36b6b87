// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "game/play/panel/panel_sections.h"
#include "game/shot/methods.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>

namespace shutter::game {

namespace {

constexpr ImU32 kText = IM_COL32(245, 245, 245, 255);
constexpr ImU32 kLabel = IM_COL32(190, 196, 204, 255);
constexpr ImU32 kEmphasis = IM_COL32(255, 221, 120, 255);
constexpr ImU32 kBack = IM_COL32(0, 0, 0, 150);

/// One that lines do not break at.
constexpr const char* kSpace = "\xc2\xa0";

ImFont& largeFont() {
    return *ImGui::GetIO().Fonts->Fonts[1];
}

ImVec2 measure(const ImFont& font, const std::string& text) {
    return font.CalcTextSizeA(font.FontSize, FLT_MAX, 0.0f, text.c_str());
}

float padding() {
    return std::floor(0.25f * ImGui::GetFontSize());
}

float margin() {
    return std::floor(0.6f * ImGui::GetFontSize());
}

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

  private:
    ImVec2 mPlace;
    float mShare;
    float mWrap = 0.0f; ///< pixels; 0: lines are as long as they are
};

/// Values side by side on one ground, each large below its small label.
/// \return where the row ends, y
float drawReadings(std::span<const HudLine> readings, const ImVec2& place) {
    const ImFont& small = *ImGui::GetFont();
    ImFont& large = largeFont();
    const float pad = padding();
    const float gap = ImGui::GetFontSize();
    const float bottom = place.y + small.FontSize + large.FontSize;
    float x = place.x;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto widthOf = [&](const HudLine& reading) {
        return std::max(measure(small, reading.label).x, measure(large, reading.text).x);
    };
    float width = gap * static_cast<float>(readings.size() - 1);
    for (const HudLine& reading : readings)
        width += widthOf(reading);
    list.AddRectFilled({x - pad, place.y - pad}, {x + width + pad, bottom + pad}, kBack);
    for (const HudLine& reading : readings) {
        list.AddText({x, place.y}, kLabel, reading.label.c_str());
        list.AddText(
            &large,
            large.FontSize,
            {x, place.y + small.FontSize},
            reading.emphasis ? kEmphasis : kText,
            reading.text.c_str()
        );
        x += std::ceil(widthOf(reading)) + gap;
    }
    return bottom + 2.0f * pad;
}

std::string describeState(const PanelFacts& facts) {
    std::string state;
    if (facts.photo)
        state = facts.photoRays
                    ? fmt::format(
                          "photo mode: truth, {} per pixel", core::countOf(*facts.photoRays, "ray")
                      )
                    : "photo mode";
    else if (facts.paused)
        state = "paused";
    else if (facts.speed != 1.0)
        state = fmt::format("speed {:g}", facts.speed);
    if (facts.recording)
        state += fmt::format("{}recording", state.empty() ? "" : ", ");
    return state;
}

void drawGame(const PanelFacts& facts) {
    float y = margin();
    const auto isReading = [](const HudLine& line) { return !line.label.empty(); };
    for (auto line = facts.hud.begin(); line != facts.hud.end();) {
        const auto end = std::find_if_not(line, facts.hud.end(), isReading);
        if (line != end) {
            y = drawReadings({line, end}, {margin(), y});
            line = end;
            continue;
        }
        TextColumn column({margin(), y}, 0.0f);
        column.add(line->text, line->emphasis ? kEmphasis : kText, line->emphasis);
        y = column.y();
        ++line;
    }
    if (const std::string state = describeState(facts); !state.empty())
        TextColumn({margin(), y}, 0.0f).add(state, kEmphasis);
}

/// \return where it ends, y
float drawRates(const PanelFacts& facts, const PlaySettings& settings) {
    TextColumn column({ImGui::GetIO().DisplaySize.x - margin(), margin()}, 1.0f);
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
    const auto describe = [&](const std::string& method, const auto* statistics) {
        return describeMethod(method, statistics, settings.budget);
    };
    if (facts.photoRays || !settings.split) {
        TextColumn({margin(), y}, 0.0f)
            .add(facts.photoRays ? "truth" : describe(settings.method, facts.right));
        return;
    }
    TextColumn({divider - gap, y}, 1.0f).add(describe(settings.leftMethod, facts.left));
    TextColumn({divider + gap, y}, 0.0f).add(describe(settings.method, facts.right));
}

std::string holdTogether(const std::string& text) {
    std::string held;
    for (const char c : text)
        held += c == ' ' ? kSpace : std::string(1, c);
    return held;
}

/// The keys in one line, which breaks between them.
std::string describeKeys(std::span<const KeyHelp> keys) {
    std::string text;
    for (const KeyHelp& one : keys)
        text += fmt::format(
            "{}{}{}{}",
            text.empty() ? "" : "    ",
            holdTogether(one.key),
            kSpace,
            holdTogether(one.what)
        );
    return text;
}

/// Text above `y`, as wide as the window at most. \return where it begins, y
float drawAbove(float y, const std::string& text, ImU32 color) {
    const float wrap = std::max(ImGui::GetIO().DisplaySize.x - 2.0f * margin(), 1.0f);
    y -= ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap).y;
    TextColumn column({margin(), y}, 0.0f);
    column.setWrap(wrap);
    column.add(text, color);
    return y - margin();
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

bool isReduced(const render::FrameStatistics& statistics) {
    const auto level = statistics.measures.find("blur budget level");
    return level != statistics.measures.end() && level->second > 0.0;
}

bool isDrawnByStandIn(const render::FrameStatistics& statistics) {
    return statistics.measures.contains("blur stands in");
}

std::string describeMethod(
    const std::string& method,
    const render::FrameStatistics* statistics,
    const motion_blur::BlurBudget& budget
) {
    if (statistics && isDrawnByStandIn(*statistics)) {
        // The player may have chosen another method since, which has no stand-in.
        const auto info = findMethod(method);
        if (info && info.value()->blur && info.value()->blur->standIn)
            return fmt::format(
                "{}: {} until its pipelines are made", method, info.value()->blur->standIn
            );
    }
    if (!statistics || budget.isUnlimited() || !isReduced(*statistics))
        return method;
    return fmt::format("{}, reduced: {:g} ms budget", method, budget.milliseconds);
}

std::string describeEffects(const PlaySettings& settings) {
    std::string text;
    const auto add = [&](std::string_view effect) {
        text += fmt::format("{}{}", text.empty() ? "" : ", ", effect);
    };
    const PictureSettings& picture = settings.picture;
    if (picture.antiAliasing != AntiAliasing::None)
        add(core::describeValue(core::getRow(listPictureRows(), "antiAliasing"), picture));
    if (picture.shadows.mode != extract::ShadowMode::None)
        add(fmt::format(
            "{} shadows",
            core::describeValue(core::getRow(extract::listShadowRows(), "shadows"), picture.shadows)
        ));
    if (settings.environment)
        add("sky");
    if (picture.bloom.share > 0.0f)
        add("bloom");
    return text;
}

HudSpace drawHud(const PanelFacts& facts, const PlaySettings& settings) {
    const float line = ImGui::GetFontSize() + 2.0f * padding();
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    HudSpace space;
    drawGame(facts);
    space.top = drawRates(facts, settings) + margin();
    float y = window.y - margin();
    if (facts.showsHint) {
        y = drawAbove(y, describeKeys(listCommonKeys()), kText);
        if (!facts.keys.empty())
            y = drawAbove(y, describeKeys(facts.keys), kText);
    }
    if (!facts.message.empty())
        y = drawAbove(y, facts.message, kEmphasis);
    if (const std::string effects = describeEffects(settings); !effects.empty())
        y = drawAbove(y, effects, kLabel) + margin() - 2.0f * padding();
    y -= line;
    drawSides(facts, settings, y);
    space.bottom = window.y - y + margin();
    return space;
}

} // namespace shutter::game
