// SPDX-License-Identifier: MIT
#include "game/setting_options.h"

#include "game/setting_table.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <string_view>

namespace shutter::game {

namespace {

using core::makeError;
using core::Status;

using motion_blur::MotionBlurSettings;
using Row = SettingRow<MotionBlurSettings>;

Status applyWord(
    const Row& row,
    const std::string& value,
    const WordField<MotionBlurSettings>& field,
    MotionBlurSettings& settings
) {
    const auto word = std::find(field.words.begin(), field.words.end(), value);
    if (word == field.words.end())
        return makeError(
            "--set {}: '{}' is not {}", row.name, value, fmt::join(field.words, " or ")
        );
    field.set(settings, static_cast<size_t>(word - field.words.begin()));
    return {};
}

Status applyNumber(const Row& row, const std::string& value, MotionBlurSettings& settings) {
    const bool isUnlimited = row.range.isUnlimited && value == kUnlimited;
    const auto number = isUnlimited ? std::numeric_limits<double>::infinity() : parseNumber(value);
    if (!number)
        return makeError("--set {}: '{}' is not a number", row.name, value);
    if (row.range.step != 0.0 && *number != std::floor(*number))
        return makeError("--set {}: {} is not a whole number", row.name, value);
    if (!setNumber(row, settings, *number))
        return makeError(
            "--set {}: {} must be {}", row.name, value, describeRange(row.range, row.unit)
        );
    return {};
}

} // namespace

std::vector<std::string> splitAt(const std::string& text, char separator) {
    std::vector<std::string> parts;
    size_t start = 0;
    for (size_t at; (at = text.find(separator, start)) != std::string::npos; start = at + 1)
        parts.push_back(text.substr(start, at - start));
    parts.push_back(text.substr(start));
    return parts;
}

std::optional<double> parseNumber(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value))
        return std::nullopt;
    return value;
}

Status applySetting(
    const std::string& text, const MethodInfo& method, motion_blur::MotionBlurSettings& settings
) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos)
        return makeError("--set '{}' is not NAME=VALUE", text);
    const std::string name = text.substr(0, equals);
    const std::string value = text.substr(equals + 1);
    std::span<const std::string_view> known;
    if (method.family == MethodFamily::MotionBlur)
        known = motion_blur::listSettings(method.blur);
    if (known.empty())
        return makeError("--set '{}': method {} has no settings", name, method.name);
    if (std::find(known.begin(), known.end(), name) == known.end())
        return makeError(
            "--set '{}': method {} has no such setting, it has {}",
            name,
            method.name,
            fmt::join(known, ", ")
        );
    const auto rows = listBlurRows();
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return name == r.name; });
    SHUTTER_CHECK(row != rows.end(), "the setting {} has no row", name);
    if (const auto* words = std::get_if<WordField<MotionBlurSettings>>(&row->field))
        return applyWord(*row, value, *words, settings);
    return applyNumber(*row, value, settings);
}

} // namespace shutter::game
