// SPDX-License-Identifier: MIT
#include "game/play/panel/setting_widgets.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <limits>

namespace shutter::game {

namespace {

double orElse(double value, double fallback) {
    return std::isnan(value) ? fallback : value;
}

std::string describeAtLength(const WidgetFormat& widget, const core::NumberRange* range) {
    std::string text = widget.meaning;
    if (range)
        text += fmt::format("\n\nRange: {}.", core::describeRange(*range, widget.unit));
    else
        text += "\n";
    return text +
           fmt::format(
               "\nDefault: {} (right click).\nIn settings files: {}.", widget.fallback, widget.name
           );
}

/// The label, and the column of the value.
void beginRow(const WidgetFormat& widget) {
    ImGui::PushID(widget.name);
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(widget.label);
}

WidgetEvent endRow(bool changed) {
    const bool reset = ImGui::IsItemClicked(ImGuiMouseButton_Right);
    ImGui::PopID();
    if (reset)
        return WidgetEvent::Reset;
    return changed ? WidgetEvent::Changed : WidgetEvent::None;
}

/// printf's, as ImGui wants it.
std::string makeFormat(const char* number, const char* unit) {
    const std::string_view name(unit);
    if (name.empty())
        return number;
    return fmt::format("{} {}", number, name == "%" ? "%%" : name);
}

bool slide(const core::NumberRange& range, const char* unit, double& value) {
    ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
    if (range.isLogarithmic)
        flags |= ImGuiSliderFlags_Logarithmic;
    const double lowest = orElse(range.sliderLowest, range.lowest);
    const double highest = orElse(range.sliderHighest, range.highest);
    ImGui::SetNextItemWidth(-std::numeric_limits<float>::min());
    if (range.step == 0.0)
        return ImGui::SliderScalar(
            "##value",
            ImGuiDataType_Double,
            &value,
            &lowest,
            &highest,
            makeFormat("%.4g", unit).c_str(),
            flags
        );
    int whole = static_cast<int>(value);
    if (!ImGui::SliderInt(
            "##value",
            &whole,
            static_cast<int>(lowest),
            static_cast<int>(highest),
            makeFormat("%d", unit).c_str(),
            flags
        ))
        return false;
    value = whole;
    return true;
}

/// An unlimited setting has no number to slide.
void showUnlimited() {
    ImGui::BeginDisabled();
    ImGui::SetNextItemWidth(-std::numeric_limits<float>::min());
    double nothing = 0.0;
    const double end = 1.0;
    ImGui::SliderScalar(
        "##value",
        ImGuiDataType_Double,
        &nothing,
        &nothing,
        &end,
        std::string(core::kUnlimited).c_str()
    );
    ImGui::EndDisabled();
}

} // namespace

bool beginRows(const char* id) {
    if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingFixedFit))
        return false;
    // As wide as the longest label, so that the values of all tables lie below one another.
    const float width = ImGui::CalcTextSize("Luminance threshold").x;
    ImGui::TableSetupColumn("label", ImGuiTableColumnFlags_WidthFixed, width);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
    return true;
}

void endRows() {
    ImGui::EndTable();
}

void drawTooltip(const std::string& text) {
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26.0f);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

double snapToRange(const core::NumberRange& range, double value) {
    const double clamped = std::clamp(value, range.lowest, range.highest);
    if (range.step == 0.0)
        return clamped;
    // Towards the lowest value, so that the result is never above the highest.
    return range.lowest + range.step * std::floor((clamped - range.lowest) / range.step);
}

WidgetEvent drawNumber(const WidgetFormat& widget, const core::NumberRange& range, double& value) {
    beginRow(widget);
    drawTooltip(describeAtLength(widget, &range));
    ImGui::TableNextColumn();
    bool changed = false;
    double chosen = value;
    if (range.isUnlimited) {
        bool isLimited = std::isfinite(value);
        if (ImGui::Checkbox("##limited", &isLimited)) {
            chosen = isLimited ? orElse(range.sliderHighest, range.highest)
                               : std::numeric_limits<double>::infinity();
            changed = true;
        }
        drawTooltip(fmt::format("On: a limit. Off: {}.", core::kUnlimited));
        ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
    }
    if (std::isfinite(chosen)) {
        // Text that a player types may not be a number.
        if (slide(range, widget.unit, chosen) && !std::isnan(chosen)) {
            chosen = snapToRange(range, chosen);
            changed = true;
        }
    } else {
        showUnlimited();
    }
    drawTooltip(describeAtLength(widget, &range));
    if (changed)
        value = chosen;
    return endRow(changed);
}

WidgetEvent
drawChoice(const WidgetFormat& widget, std::span<const std::string_view> words, size_t& index) {
    beginRow(widget);
    drawTooltip(describeAtLength(widget, nullptr));
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-std::numeric_limits<float>::min());
    bool changed = false;
    if (ImGui::BeginCombo("##value", std::string(words[index]).c_str())) {
        for (size_t i = 0; i < words.size(); ++i)
            if (ImGui::Selectable(std::string(words[i]).c_str(), i == index)) {
                changed = i != index;
                index = i;
            }
        ImGui::EndCombo();
    }
    drawTooltip(describeAtLength(widget, nullptr));
    return endRow(changed);
}

WidgetEvent drawSwitch(const WidgetFormat& widget, bool& value) {
    beginRow(widget);
    drawTooltip(describeAtLength(widget, nullptr));
    ImGui::TableNextColumn();
    const bool changed = ImGui::Checkbox("##value", &value);
    drawTooltip(describeAtLength(widget, nullptr));
    return endRow(changed);
}

} // namespace shutter::game
