// SPDX-License-Identifier: MIT
#include "engine/core/setting_row.h"

#include <cstdlib>

namespace shutter::core {

bool contains(const NumberRange& range, double value) {
    if (range.isUnlimited && value == std::numeric_limits<double>::infinity())
        return true;
    // Written so that NaN is outside.
    const bool isHighEnough = range.isLowestValid ? value >= range.lowest : value > range.lowest;
    if (!(isHighEnough && value <= range.highest))
        return false;
    return range.step == 0.0 || std::fmod(value - range.lowest, range.step) == 0.0;
}

std::string describeRange(const NumberRange& range, const char* unit) {
    std::string text = fmt::format(
        "{}{:g} {} {:g}",
        range.isLowestValid ? "" : "above ",
        range.lowest,
        range.isLowestValid ? "to" : "up to",
        range.highest
    );
    if (*unit != '\0')
        text += fmt::format(" {}", unit);
    if (range.step > 1.0)
        text += fmt::format(" in steps of {:g}", range.step);
    else if (range.step == 1.0)
        text += ", whole";
    if (range.isUnlimited)
        text += fmt::format(" or {}", kUnlimited);
    return text;
}

double shortestOf(float value) {
    return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

std::optional<double> parseNumber(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value))
        return std::nullopt;
    return value;
}

} // namespace shutter::core
