// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

namespace shutter::bench {

struct CurvePoint {
    double x = 0.0;
    double y = 0.0;
};

/// y = intercept + slope x.
struct LineFit {
    double slope = 0.0;     ///< units of y a unit of x
    double intercept = 0.0; ///< units of y
    double r2 = 0.0;        ///< share of the variance of y explained, [0, 1]; 1 where y is constant
};

/// Least squares. Nothing where a value is not finite or there are fewer than two different x.
[[nodiscard]] std::optional<LineFit> fitLine(std::span<const CurvePoint> points);

/// y = c x^exponent.
struct PowerFit {
    double exponent = 0.0;
    double r2 = 0.0; ///< share of the logarithms' variance explained, [0, 1]; 1 where y is constant
    double from = 0.0; ///< smallest and largest x of the points that were fitted
    double to = 0.0;
};

/// Least squares of the logarithms. Nothing where a point has no logarithm (x or y not above 0) or
/// where there are fewer than two different x.
[[nodiscard]] std::optional<PowerFit> fitPower(std::span<const CurvePoint> points);

} // namespace shutter::bench
