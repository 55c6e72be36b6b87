// SPDX-License-Identifier: MIT
// A widget a row of settings: label, value with its unit, and a tooltip with meaning, range,
// default and the name in settings files.
#pragma once

#include "engine/core/setting_row.h"
#include "modules/motion_blur/settings.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace shutter::game {

/// Label and format of a widget.
struct WidgetFormat {
    const char* name;  ///< in settings files
    const char* label; ///< for people
    const char* unit;
    const char* meaning;
    std::string fallback; ///< the default, in words
};

enum class WidgetEvent : uint8_t {
    None,
    Changed,
    Reset, ///< a right click: back to the default
};

/// Begins a table of rows. False if it is out of sight: then call neither rows nor endRows().
[[nodiscard]] bool beginRows(const char* id);
void endRows();

/// A changed value lies in the range: what a player types beyond it is clamped, and text that is
/// not a number is dropped.
[[nodiscard]] WidgetEvent
drawNumber(const WidgetFormat& widget, const core::NumberRange& range, double& value);
[[nodiscard]] WidgetEvent
drawChoice(const WidgetFormat& widget, std::span<const std::string_view> words, size_t& index);
[[nodiscard]] WidgetEvent drawSwitch(const WidgetFormat& widget, bool& value);

/// Shown while the pointer is over the last item, a disabled one too.
void drawTooltip(const std::string& text);

/// A slider's whole number in steps, or the value itself where the range has no steps.
[[nodiscard]] double snapToRange(const core::NumberRange& range, double value);

/// The row's field as a widget. \param defaults where a click with the right button leads
template <class Owner>
void drawRow(const core::SettingRow<Owner>& row, Owner& owner, const Owner& defaults) {
    const WidgetFormat widget{
        row.name, row.label, row.unit, row.meaning, describeValue(row, defaults)};
    if (const auto* yes = std::get_if<bool Owner::*>(&row.field)) {
        if (drawSwitch(widget, owner.**yes) == WidgetEvent::Reset)
            owner.** yes = defaults.**yes;
        return;
    }
    if (const auto* words = std::get_if<core::WordField<Owner>>(&row.field)) {
        size_t index = words->get(owner);
        const WidgetEvent event = drawChoice(widget, words->words, index);
        if (event != WidgetEvent::None)
            words->set(owner, event == WidgetEvent::Reset ? words->get(defaults) : index);
        return;
    }
    double value = getNumber(row, owner);
    const WidgetEvent event = drawNumber(widget, row.range, value);
    if (event != WidgetEvent::None)
        setNumber(row, owner, event == WidgetEvent::Reset ? getNumber(row, defaults) : value);
}

/// All rows in a separate table.
template <class Owner>
void drawRows(
    const char* id,
    std::span<const core::SettingRow<Owner>> rows,
    Owner& owner,
    const Owner& defaults = Owner{}
) {
    if (!beginRows(id))
        return;
    for (const core::SettingRow<Owner>& row : rows)
        drawRow(row, owner, defaults);
    endRows();
}

} // namespace shutter::game
