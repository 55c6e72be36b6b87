// SPDX-License-Identifier: MIT
// Settings as data: one row per field of a struct, with its name, range, unit and meaning.
// Validation, the command line, JSON and its schema, panels and documentation are loops over rows,
// so that a new setting is a field and a row.
#pragma once

#include "engine/core/check.h"
#include "engine/core/frame_rate.h"
#include "engine/core/result.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace shutter::core {

/// A field whose values are words: an enum whose values count from 0 in the order of the words.
template <class Owner> struct WordField {
    std::span<const std::string_view> words;
    size_t (*get)(const Owner&);
    void (*set)(Owner&, size_t);
};

/// The numbers that a field takes.
struct NumberRange {
    double lowest = 0.0;
    double highest = 1.0;
    double step = 0.0;          ///< distance between values, from `lowest` on; 0: any value
    bool isLowestValid = true;  ///< false: values must be above `lowest`
    bool isUnlimited = false;   ///< infinity is valid too and is written "unlimited"
    bool isRate = false;        ///< frames a second: text may be a fraction, "24000/1001"
    bool isLogarithmic = false; ///< sliders move by factors
    /// Limits of a slider that shows a part of the range only; NaN: the range's own.
    double sliderLowest = std::numeric_limits<double>::quiet_NaN();
    double sliderHighest = std::numeric_limits<double>::quiet_NaN();
};

/// One field of `Owner`.
template <class Owner> struct SettingRow {
    /// The field's in JSON and --set, as in C++; with its struct's name where a file holds the
    /// fields of several structs in one object ("bloomShare").
    const char* name;
    std::
        variant<bool Owner::*, uint32_t Owner::*, float Owner::*, double Owner::*, WordField<Owner>>
            field;
    const char* unit;        ///< of a number; empty: none
    NumberRange range;       ///< unused unless the field is a number
    const char* meaning;     ///< one or two sentences for people
    const char* label = "";  ///< a few words for people; empty: the name serves
    const char* option = ""; ///< command-line option, "--exposure"; empty: none
};

template <class Owner> using SettingRows = std::span<const SettingRow<Owner>>;

/// How infinity is written.
inline constexpr std::string_view kUnlimited = "unlimited";

/// False for NaN.
[[nodiscard]] bool contains(const NumberRange& range, double value);

/// "1 to 256 px", "above 0 up to 1000 fps", "2 to 1e6 px or unlimited", "1 to 15 in steps of 2".
[[nodiscard]] std::string describeRange(const NumberRange& range, const char* unit);

/// The number with the fewest decimal digits that is read back as the same float.
[[nodiscard]] double shortestOf(float value);

template <class Owner> [[nodiscard]] bool isNumber(const SettingRow<Owner>& row) {
    return std::holds_alternative<uint32_t Owner::*>(row.field) ||
           std::holds_alternative<float Owner::*>(row.field) ||
           std::holds_alternative<double Owner::*>(row.field);
}

/// The row must be a number's (CHECKed).
template <class Owner>
[[nodiscard]] double getNumber(const SettingRow<Owner>& row, const Owner& owner) {
    if (const auto* whole = std::get_if<uint32_t Owner::*>(&row.field))
        return owner.**whole;
    if (const auto* single = std::get_if<float Owner::*>(&row.field))
        return shortestOf(owner.**single);
    const auto* real = std::get_if<double Owner::*>(&row.field);
    SHUTTER_CHECK(real, "{} is not a number", row.name);
    return owner.**real;
}

/// Changes nothing and returns false unless the range contains the value. The row must be a
/// number's (CHECKed).
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
        SHUTTER_CHECK(false, "{} is not a number", row.name);
    return true;
}

/// The value as settings files write it.
template <class Owner>
[[nodiscard]] std::string describeValue(const SettingRow<Owner>& row, const Owner& owner) {
    if (const auto* yes = std::get_if<bool Owner::*>(&row.field))
        return owner.**yes ? "true" : "false";
    if (const auto* words = std::get_if<WordField<Owner>>(&row.field))
        return std::string(words->words[words->get(owner)]);
    const double value = getNumber(row, owner);
    return std::isinf(value) ? std::string(kUnlimited) : fmt::format("{}", value);
}

/// "1 to 256 px", "box or triangle", "true or false".
template <class Owner> [[nodiscard]] std::string describeValues(const SettingRow<Owner>& row) {
    if (std::holds_alternative<bool Owner::*>(row.field))
        return "true or false";
    const auto* words = std::get_if<WordField<Owner>>(&row.field);
    if (!words)
        return describeRange(row.range, row.unit);
    std::string text;
    for (const std::string_view word : words->words)
        text += fmt::format("{}{}", text.empty() ? "" : " or ", word);
    return text;
}

/// A whole string as a finite number.
[[nodiscard]] std::optional<double> parseNumber(const std::string& text);

/// Sets the field from text as describeValue() writes it. Error: names the text and the values
/// there are.
template <class Owner>
[[nodiscard]] Status
parseValue(const SettingRow<Owner>& row, const std::string& text, Owner& owner) {
    if (auto* yes = std::get_if<bool Owner::*>(&row.field)) {
        if (text != "true" && text != "false")
            return makeError("'{}' is not true or false", text);
        owner.** yes = text == "true";
        return {};
    }
    if (const auto* words = std::get_if<WordField<Owner>>(&row.field)) {
        for (size_t i = 0; i < words->words.size(); ++i)
            if (words->words[i] == text) {
                words->set(owner, i);
                return {};
            }
        return makeError("'{}' is not {}", text, describeValues(row));
    }
    const bool isInfinite = row.range.isUnlimited && text == kUnlimited;
    std::optional<double> number =
        isInfinite ? std::numeric_limits<double>::infinity() : parseNumber(text);
    if (!number && row.range.isRate)
        if (const auto rate = parseFrameRate(text))
            number = rate.value().perSecond();
    if (!number)
        return makeError("'{}' is not a number", text);
    if (!setNumber(row, owner, *number))
        return makeError("{} must be {}", text, describeRange(row.range, row.unit));
    return {};
}

template <class Owner>
[[nodiscard]] const SettingRow<Owner>* findRow(SettingRows<Owner> rows, std::string_view name) {
    for (const SettingRow<Owner>& row : rows)
        if (row.name == name)
            return &row;
    return nullptr;
}

/// The row of that name, which must exist (CHECKed).
template <class Owner>
[[nodiscard]] const SettingRow<Owner>& getRow(SettingRows<Owner> rows, std::string_view name) {
    const SettingRow<Owner>* row = findRow(rows, name);
    SHUTTER_CHECK(row, "there is no row {}", name);
    return *row;
}

/// Sets the row's field of `to` to that of `from`.
template <class Owner> void copyValue(const SettingRow<Owner>& row, const Owner& from, Owner& to) {
    std::visit(
        [&](const auto& field) {
            if constexpr (requires { to.*field; })
                to.*field = from.*field;
            else
                field.set(to, field.get(from));
        },
        row.field
    );
}

/// True if both have the same values in all rows.
template <class Owner>
[[nodiscard]] bool areEqual(SettingRows<Owner> rows, const Owner& a, const Owner& b) {
    for (const SettingRow<Owner>& row : rows)
        if (describeValue(row, a) != describeValue(row, b))
            return false;
    return true;
}

/// "tileSizePx=40 jitter=1 ...": differs wherever a value does.
template <class Owner>
[[nodiscard]] std::string describeValues(SettingRows<Owner> rows, const Owner& owner) {
    std::string text;
    for (const SettingRow<Owner>& row : rows)
        text +=
            fmt::format("{}{}={}", text.empty() ? "" : " ", row.name, describeValue(row, owner));
    return text;
}

/// One sentence that names the field whose number is out of its range.
/// \param prefix before the field's name, e.g. "shutter."
template <class Owner>
[[nodiscard]] Status
validateRows(SettingRows<Owner> rows, const Owner& owner, std::string_view prefix) {
    for (const SettingRow<Owner>& row : rows) {
        if (isNumber(row) && !contains(row.range, getNumber(row, owner)))
            return makeError(
                "{}{} is {}, it must be {}",
                prefix,
                row.name,
                getNumber(row, owner),
                describeRange(row.range, row.unit)
            );
        const auto* words = std::get_if<WordField<Owner>>(&row.field);
        if (words && words->get(owner) >= words->words.size())
            return makeError(
                "{}{} is the value {}, it must be {}",
                prefix,
                row.name,
                words->get(owner),
                describeValues(row)
            );
    }
    return {};
}

/// What WordField needs to know of `member`; `words` must have static storage.
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

} // namespace shutter::core
