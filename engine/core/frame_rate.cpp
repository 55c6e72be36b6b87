// SPDX-License-Identifier: MIT
#include "engine/core/frame_rate.h"

#include "engine/core/setting_row.h"

#include <cmath>
#include <limits>
#include <regex>

namespace shutter::core {

namespace {

constexpr double kMaxTerm = std::numeric_limits<int32_t>::max();

bool isTerm(double value) {
    return value >= 1.0 && value <= kMaxTerm;
}

} // namespace

Result<FrameRate> parseFrameRate(const std::string& text) {
    static const std::regex kFraction("([0-9]{1,10})/([0-9]{1,10})");
    std::smatch match;
    if (std::regex_match(text, match, kFraction)) {
        const FrameRate rate(std::stod(match.str(1)), std::stod(match.str(2)));
        if (isTerm(rate.numerator) && isTerm(rate.denominator))
            return rate;
    } else if (const auto number = parseNumber(text); number && *number > 0.0) {
        return FrameRate(*number);
    }
    return makeError(
        "'{}' is neither a number above 0 nor a fraction of whole numbers above 0 such as "
        "24000/1001",
        text
    );
}

std::string describe(const FrameRate& rate) {
    return rate.denominator == 1.0 ? fmt::format("{}", rate.numerator)
                                   : fmt::format("{:.0f}/{:.0f}", rate.numerator, rate.denominator);
}

std::optional<RationalRate> findRational(const FrameRate& rate) {
    if (rate.denominator != 1.0)
        return RationalRate{int32_t(rate.numerator), uint32_t(rate.denominator)};
    // The convergents p / q of the continued fraction: each is the nearest of all whose terms are
    // not larger.
    double p = std::floor(rate.numerator);
    double q = 1.0;
    double pBefore = 1.0;
    double qBefore = 0.0;
    double rest = rate.numerator - p;
    while (p / q != rate.numerator && rest > 0.0) {
        const double inverse = 1.0 / rest;
        const double whole = std::floor(inverse);
        const double pNext = whole * p + pBefore;
        const double qNext = whole * q + qBefore;
        if (!(pNext <= kMaxTerm && qNext <= kMaxTerm))
            break;
        rest = inverse - whole;
        pBefore = p;
        qBefore = q;
        p = pNext;
        q = qNext;
    }
    if (!isTerm(p))
        return std::nullopt;
    return RationalRate{int32_t(p), uint32_t(q)};
}

} // namespace shutter::core
