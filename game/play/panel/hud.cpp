// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "game/play/panel/effect_switches.h"
#include "game/play/panel/panel_sections.h"
#include "game/shot/methods.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <optional>

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

/// Whole pixels. \param wrap width at which lines break; 0: nowhere
ImVec2 measure(const ImFont& font, const std::string& text, float wrap = 0.0f) {
    const ImVec2 size = font.CalcTextSizeA(font.FontSize, FLT_MAX, wrap, text.c_str());
    return {std::ceil(size.x), std::ceil(size.y)};
}

float padding() {
    return std::floor(0.25f * ImGui::GetFontSize());
}

float margin() {
    return std::floor(0.6f * ImGui::GetFontSize());
}

/// Width of a line at most, pixels.
float widest() {
    return std::max(ImGui::GetIO().DisplaySize.x - 2.0f * margin(), 1.0f);
}

enum class Way : uint8_t { Down, Up };

/// Dark backgrounds behind lines of text, so that they are readable over any picture.
class Grounds {
  public:
    /// Draws the ground of a text of `size` where there is room for it: at `place` or beyond what
    /// is there. \return the text's upper left corner; nothing: there is no room in the window
    std::optional<ImVec2> take(const ImVec2& place, const ImVec2& size, Way way) {
        const float pad = padding();
        const float leftmost = std::max(ImGui::GetIO().DisplaySize.x - margin() - size.x, margin());
        const float x = std::clamp(std::floor(place.x), margin(), leftmost);
        const float y = std::floor(place.y);
        HudRect own{x - pad, y - pad, x + size.x + pad, y + size.y + pad};
        const auto meets = [&](const HudRect& other) {
            return own.left < other.right && other.left < own.right && own.top < other.bottom &&
                   other.top < own.bottom;
        };
        for (auto met = mTaken.begin(); met != mTaken.end();) {
            met = std::find_if(mTaken.begin(), mTaken.end(), meets);
            if (met == mTaken.end())
                break;
            const float shift = way == Way::Down ? met->bottom - own.top : met->top - own.bottom;
            own.top += shift;
            own.bottom += shift;
        }
        if (own.top < 0.0f || own.bottom > ImGui::GetIO().DisplaySize.y)
            return std::nullopt;
        mTaken.push_back(own);
        ImGui::GetBackgroundDrawList()->AddRectFilled(
            {own.left, own.top}, {own.right, own.bottom}, kBack
        );
        return ImVec2{own.left + pad, own.top + pad};
    }

    [[nodiscard]] const std::vector<HudRect>& taken() const { return mTaken; }

  private:
    std::vector<HudRect> mTaken;
};

/// Lines of text, one below or above the other.
class TextColumn {
  public:
    /// \param place upper corner, or with Way::Up the lower one
    /// \param share of a line's width that lies left of the place
    TextColumn(Grounds& grounds, const ImVec2& place, float share, Way way = Way::Down)
        : mGrounds(grounds), mPlace(place), mShare(share), mWay(way) {}

    void add(const std::string& text, ImU32 color = kText, bool large = false) {
        ImFont* font = ImGui::GetIO().Fonts->Fonts[large ? 1 : 0];
        const ImVec2 size = measure(*font, text, widest());
        const float above = mWay == Way::Up ? size.y : 0.0f;
        const auto from = mGrounds.take({mPlace.x - mShare * size.x, mPlace.y - above}, size, mWay);
        if (!from)
            return;
        ImGui::GetBackgroundDrawList()->AddText(
            font, font->FontSize, *from, color, text.c_str(), nullptr, widest()
        );
        mPlace.y =
            mWay == Way::Up ? from->y - 2.0f * padding() : from->y + size.y + 2.0f * padding();
    }

    /// Where the next line begins or, with Way::Up, ends.
    [[nodiscard]] float y() const { return mPlace.y; }

  private:
    Grounds& mGrounds;
    ImVec2 mPlace;
    float mShare;
    Way mWay;
};

/// Values side by side on one ground, each large below its small label; as many as there is room
/// for, and the others below.
/// \return where they end, y
float drawReadings(Grounds& grounds, std::span<const HudLine> readings, const ImVec2& place) {
    const ImFont& small = *ImGui::GetFont();
    ImFont& large = largeFont();
    const float gap = ImGui::GetFontSize();
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto widthOf = [&](const HudLine& reading) {
        return std::max(measure(small, reading.label).x, measure(large, reading.text).x);
    };
    size_t count = 1;
    ImVec2 size{widthOf(readings[0]), std::ceil(small.FontSize + large.FontSize)};
    for (; count < readings.size(); ++count) {
        const float more = gap + widthOf(readings[count]);
        if (size.x + more > widest())
            break;
        size.x += more;
    }
    const auto from = grounds.take(place, size, Way::Down);
    if (!from)
        return place.y;
    float x = from->x;
    for (const HudLine& reading : readings.first(count)) {
        list.AddText({x, from->y}, kLabel, reading.label.c_str());
        list.AddText(
            &large,
            large.FontSize,
            {x, from->y + small.FontSize},
            reading.emphasis ? kEmphasis : kText,
            reading.text.c_str()
        );
        x += widthOf(reading) + gap;
    }
    const float end = from->y + size.y + 2.0f * padding();
    return count < readings.size() ? drawReadings(grounds, readings.subspan(count), {place.x, end})
                                   : end;
}

void drawGame(Grounds& grounds, const PanelFacts& facts, const PlaySettings& settings) {
    float y = margin();
    const auto isReading = [](const HudLine& line) { return !line.label.empty(); };
    // The game rests in photo mode, and its picture is what matters.
    const auto hud = facts.photo ? std::span<const HudLine>() : facts.hud;
    for (auto line = hud.begin(); line != hud.end();) {
        const auto end = std::find_if_not(line, hud.end(), isReading);
        if (line != end) {
            y = drawReadings(grounds, {line, end}, {margin(), y});
            line = end;
            continue;
        }
        TextColumn column(grounds, {margin(), y}, 0.0f);
        column.add(line->text, line->emphasis ? kEmphasis : kText, line->emphasis);
        y = column.y();
        ++line;
    }
    if (const std::string state = describeState(facts, settings.view); !state.empty())
        TextColumn(grounds, {margin(), y}, 0.0f).add(state, kEmphasis);
    if (!facts.notice.empty()) {
        const ImVec2 window = ImGui::GetIO().DisplaySize;
        TextColumn(grounds, {0.5f * window.x, 0.4f * window.y}, 0.5f)
            .add(facts.notice, kEmphasis, true);
    }
}

/// \return where it ends, y
float drawRates(Grounds& grounds, const PanelFacts& facts, const PlaySettings& settings) {
    TextColumn column(grounds, {ImGui::GetIO().DisplaySize.x - margin(), margin()}, 1.0f);
    const double milliseconds = facts.frameMilliseconds;
    if (milliseconds > 0.0 && std::isfinite(milliseconds))
        column.add(fmt::format("{:.1f} fps   {:.1f} ms", 1000.0 / milliseconds, milliseconds));
    if (facts.photo)
        return column.y(); // the time of a frame is not that of the picture
    if (facts.left && settings.split)
        column.add("left: " + describeBlurCost(settings.leftMethod, *facts.left, milliseconds));
    if (facts.right)
        column.add(
            (facts.left && settings.split ? "right: " : "") +
            describeBlurCost(settings.method, *facts.right, milliseconds)
        );
    return column.y();
}

/// \param y where they end \return where they begin, y
float drawSides(Grounds& grounds, const PanelFacts& facts, const PlaySettings& settings, float y) {
    const float gap = ImGui::GetFontSize();
    const float width = ImGui::GetIO().DisplaySize.x;
    const float divider = std::floor(width * static_cast<float>(settings.dividerShare));
    const auto describe = [&](const std::string& method, const auto* statistics) {
        return describeMethod(
            method, statistics, settings.budgetShare < 1.0 || !settings.budget.isUnlimited()
        );
    };
    if (facts.photo)
        return y; // describeState() names it
    if (!settings.split) {
        TextColumn side(grounds, {margin(), y}, 0.0f, Way::Up);
        side.add(describe(settings.method, facts.right));
        return side.y();
    }
    TextColumn left(grounds, {divider - gap, y}, 1.0f, Way::Up);
    left.add(describe(settings.leftMethod, facts.left));
    TextColumn right(grounds, {divider + gap, y}, 0.0f, Way::Up);
    right.add(describe(settings.method, facts.right));
    return std::min(left.y(), right.y());
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

/// Text above `y`. \return where the one above it ends, y
float drawAbove(Grounds& grounds, float y, const std::string& text, ImU32 color) {
    TextColumn column(grounds, {margin(), y}, 0.0f, Way::Up);
    column.add(text, color);
    return column.y() + 2.0f * padding() - margin();
}

/// The most important keys, unless they take more than a third of the window.
/// \return y of their upper end
float drawHint(Grounds& grounds, const PanelFacts& facts, float y) {
    // Photo mode has separate keys.
    const std::string common = facts.photo ? "" : describeKeys(listCommonKeys());
    const std::string more = describeKeys(facts.keys);
    const ImFont& font = *ImGui::GetFont();
    if (3.0f * (measure(font, common, widest()).y + measure(font, more, widest()).y) >
        ImGui::GetIO().DisplaySize.y)
        return y;
    for (const std::string& line : {common, more})
        if (!line.empty())
            y = drawAbove(grounds, y, line, kText);
    return y;
}

} // namespace

std::string describeBlurCost(
    const std::string& method, const render::FrameStatistics& statistics, double frameMilliseconds
) {
    const auto info = findMethod(method);
    const double blur = info ? sumBlurMilliseconds(*info.value(), statistics) : 0.0;
    std::string text = fmt::format("motion blur {:.1f} ms", blur);
    if (blur <= frameMilliseconds && frameMilliseconds > 0.0 && std::isfinite(frameMilliseconds))
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

std::string findDrawnMethod(const std::string& method, const render::FrameStatistics* statistics) {
    const auto info = findMethod(method);
    if (!statistics || !info || !info.value()->blur)
        return method;
    const auto* drawn = render::findDecision(
        statistics->explanations, motion_blur::nameReplacement(*info.value()->blur)
    );
    return drawn ? drawn->reason : method;
}

std::string describeMethod(
    const std::string& method, const render::FrameStatistics* statistics, bool isLimited
) {
    const std::string drawn = findDrawnMethod(method, statistics);
    if (statistics && isDrawnByStandIn(*statistics))
        return drawn == method ? method
                               : fmt::format("{}: {} until its pipelines are made", method, drawn);
    if (!statistics || !isLimited || !isReduced(*statistics))
        return method;
    return drawn == method ? fmt::format("{}, reduced: budget, F1", method)
                           : fmt::format("{} for {}: budget, F1", drawn, method);
}

std::string describeState(const PanelFacts& facts, const std::string& view) {
    std::vector<std::string> parts;
    if (facts.photoRays)
        parts.push_back(fmt::format(
            "photo mode: {}, {} per pixel",
            facts.photoMethod,
            core::countOf(*facts.photoRays, "ray")
        ));
    else if (facts.photo)
        parts.push_back(fmt::format("photo mode: {}", facts.photoMethod));
    else if (facts.paused)
        parts.emplace_back("paused");
    if (facts.speed != 1.0 && !facts.photo)
        parts.push_back(fmt::format("speed {:g}", facts.speed));
    if (facts.recording)
        parts.emplace_back("recording");
    if (!view.empty() && !facts.photo)
        parts.push_back(fmt::format(
            "view: {}{}", view, facts.isViewMissing ? ", which this frame does not have" : ""
        ));
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::string describeEffects(const PlaySettings& settings) {
    std::vector<std::string> effects;
    for (const EffectSwitch& effect : listEffectSwitches())
        effects.push_back(effect.describe(settings));
    std::erase(effects, "");
    return fmt::format("{}", fmt::join(effects, ", "));
}

void drawNotice(const std::string& text) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImFont& font = largeFont();
    const ImVec2 size = measure(font, text);
    ImGui::GetBackgroundDrawList()->AddText(
        &font,
        font.FontSize,
        {std::floor(0.5f * (window.x - size.x)), std::floor(0.5f * (window.y - size.y))},
        kText,
        text.c_str()
    );
}

HudSpace drawHud(const PanelFacts& facts, const PlaySettings& settings) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    Grounds grounds;
    HudSpace space;
    drawGame(grounds, facts, settings);
    float y = window.y - margin();
    if (facts.showsHint)
        y = drawHint(grounds, facts, y);
    if (!facts.message.empty())
        y = drawAbove(grounds, y, facts.message, kEmphasis);
    if (const std::string effects = describeEffects(settings); !effects.empty() && !facts.photo)
        y = drawAbove(grounds, y, effects, kLabel) + margin() - 2.0f * padding();
    y = drawSides(grounds, facts, settings, y - 2.0f * padding());
    space.bottom = window.y - (y + 2.0f * padding()) + margin();
    space.top = drawRates(grounds, facts, settings) + margin(); // the first to find no room
    space.lines = grounds.taken();
    return space;
}

} // namespace shutter::game
