// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <optional>
#include <string>

namespace shutter::core {

/// Frames per second: a number, or an exact fraction such as 24000/1001.
struct FrameRate {
    /// \param top above 0 and finite; whole where it is divided
    FrameRate(double top = 24.0, double bottom = 1.0) : numerator(top), denominator(bottom) {}

    double numerator;   ///< above 0, finite
    double denominator; ///< 1, or a whole number above 0

    [[nodiscard]] double perSecond() const { return numerator / denominator; }

    /// Duration of so many frames, seconds.
    [[nodiscard]] double secondsOf(double frames) const { return frames * denominator / numerator; }

    friend bool operator==(const FrameRate&, const FrameRate&) = default;
};

/// Reads a number above 0, or a fraction of two whole numbers from 1 to 2147483647.
/// Error: a sentence without the name of the option or field.
[[nodiscard]] Result<FrameRate> parseFrameRate(const std::string& text);

/// As parseFrameRate() reads it: "24", "29.97", "24000/1001".
[[nodiscard]] std::string describe(const FrameRate& rate);

/// A rate as files store it.
struct RationalRate {
    int32_t numerator = 0;
    uint32_t denominator = 1;

    bool operator==(const RationalRate&) const = default;
};

/// The fraction itself; of a number, the simplest fraction that is the same double, or else the
/// nearest. Nothing where the rate is too small or too large for one.
[[nodiscard]] std::optional<RationalRate> findRational(const FrameRate& rate);

} // namespace shutter::core
