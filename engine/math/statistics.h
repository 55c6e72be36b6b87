// SPDX-License-Identifier: MIT
// Quartiles and least squares of measured values.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace shutter::math {

/// Where the middle half of repeated measurements lies.
struct Quartiles {
    double median = 0.0;
    double q1 = 0.0; ///< a quarter of the values is at most this
    double q3 = 0.0; ///< three quarters are
};

/// Linear between the two nearest values (type 7 of Hyndman and Fan 1996, as NumPy and R do).
/// \param values at least one (CHECKed)
[[nodiscard]] Quartiles computeQuartiles(std::vector<double> values);

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

} // namespace shutter::math
