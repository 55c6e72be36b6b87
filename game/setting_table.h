// SPDX-License-Identifier: MIT
// Settings as people meet them: a row a field, with its name, unit, range and meaning. The command
// line, settings files and the panel are made of rows.
#pragma once

#include "engine/core/result.h"
#include "modules/motion_blur/settings.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace shutter::game {

/// A field whose values are words: an enum from 0 on in their order.
template <class Owner> struct WordField {
    std::span<const std::string_view> words;
    size_t (*get)(const Owner&);
    void (*set)(Owner&, size_t);
};

/// What numbers a field takes.
struct NumberRange {
    double lowest = 0.0;
    double highest = 1.0;
    double step = 0.0;        ///< between values, from the lowest on; 0: any value
    bool isUnlimited = false; ///< infinity is one too, "unlimited"
    bool isLogarithmic = false;
    /// Of a slider, where all of the range is too much of it; NaN: the range's.
    double slideLowest = std::numeric_limits<double>::quiet_NaN();
    double slideHighest = std::numeric_limits<double>::quiet_NaN();
};

template <class Owner> struct SettingRow {
    const char* name; ///< the field's
    std::
        variant<bool Owner::*, uint32_t Owner::*, float Owner::*, double Owner::*, WordField<Owner>>
            field;
    const char* unit; ///< of a number; empty: none
    NumberRange range;
    const char* meaning; ///< for a person, in a sentence or two
};

/// The fields of MotionBlurSettings but `method`. Ranges are those of motion_blur::validate, but
/// that what may be infinite is up to 1e6 where it is not.
[[nodiscard]] std::span<const SettingRow<motion_blur::MotionBlurSettings>> listBlurRows();

/// How settings write infinity.
inline constexpr std::string_view kUnlimited = "unlimited";

/// NaN is in no range.
[[nodiscard]] bool contains(const NumberRange& range, double value);

/// "1 to 256 px", "2 to 1e6 px or unlimited", "1 to 15 in steps of 2".
[[nodiscard]] std::string describeRange(const NumberRange& range, const char* unit);

/// The number with the fewest digits that is that float.
[[nodiscard]] double shortestOf(float value);

/// Only of rows of numbers (CHECKed).
template <class Owner>
[[nodiscard]] double getNumber(const SettingRow<Owner>& row, const Owner& owner) {
    if (const auto* whole = std::get_if<uint32_t Owner::*>(&row.field))
        return owner.**whole;
    if (const auto* single = std::get_if<float Owner::*>(&row.field))
        return shortestOf(owner.**single);
    const auto* real = std::get_if<double Owner::*>(&row.field);
    SHUTTER_CHECK(real, "{} is no number", row.name);
    return owner.**real;
}

/// Changes nothing and returns false where the range does not contain the value.
template <class Owner> bool setNumber(const SettingRow<Owner>& row, Owner& owner, double value) {
    if (!contains(row.range, value))
        return false;
    if (const auto* whole = std::get_if<uint32_t Owner::*>(&row.field))
        owner.** whole = static_cast<uint32_t>(value);
    else if (const auto* single = std::get_if<float Owner::*>(&row.field))
        owner.** single = static_cast<float>(value);
    else if (const auto* real = std::get_if<double Owner::*>(&row.field))
        owner.** real = value;
    else
        SHUTTER_CHECK(false, "{} is no number", row.name);
    return true;
}

template <class Owner> [[nodiscard]] bool isNumber(const SettingRow<Owner>& row) {
    return std::holds_alternative<uint32_t Owner::*>(row.field) ||
           std::holds_alternative<float Owner::*>(row.field) ||
           std::holds_alternative<double Owner::*>(row.field);
}

/// As settings files write it.
template <class Owner>
[[nodiscard]] std::string describeValue(const SettingRow<Owner>& row, const Owner& owner) {
    if (const auto* yes = std::get_if<bool Owner::*>(&row.field))
        return owner.**yes ? "true" : "false";
    if (const auto* words = std::get_if<WordField<Owner>>(&row.field))
        return std::string(words->words[words->get(owner)]);
    const double value = getNumber(row, owner);
    return std::isinf(value) ? std::string(kUnlimited) : fmt::format("{}", value);
}

/// Both have the same values in all rows.
template <class Owner>
[[nodiscard]] bool
areEqual(std::span<const SettingRow<Owner>> rows, const Owner& a, const Owner& b) {
    for (const SettingRow<Owner>& row : rows)
        if (describeValue(row, a) != describeValue(row, b))
            return false;
    return true;
}

/// One sentence naming the field whose number is out of its range.
/// \param prefix before the field's name, e.g. "shutter."
template <class Owner>
[[nodiscard]] core::Status
validateRows(std::span<const SettingRow<Owner>> rows, const Owner& owner, const char* prefix) {
    for (const SettingRow<Owner>& row : rows)
        if (isNumber(row) && !contains(row.range, getNumber(row, owner)))
            return core::makeError(
                "{}{} is {}, it must be {}",
                prefix,
                row.name,
                getNumber(row, owner),
                describeRange(row.range, row.unit)
            );
    return {};
}

/// What of `member` WordField needs; `words` must have static storage.
template <auto member, class Owner, class Word>
[[nodiscard]] WordField<Owner> makeWords(Word Owner::*, std::span<const std::string_view> words) {
    return {
        words,
        [](const Owner& owner) { return static_cast<size_t>(owner.*member); },
        [](Owner& owner, size_t index) { owner.*member = static_cast<Word>(index); }};
}

/// An enum's field, e.g. makeWordField<&MotionBlurSettings::objectTest>(kWords).
template <auto member> [[nodiscard]] auto makeWordField(std::span<const std::string_view> words) {
    return makeWords<member>(member, words);
}

} // namespace shutter::game
