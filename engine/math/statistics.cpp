// SPDX-License-Identifier: MIT
#include "engine/math/statistics.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>

namespace shutter::math {

std::optional<LineFit> fitLine(std::span<const CurvePoint> points) {
    const double count = double(points.size());
    double meanX = 0.0;
    double meanY = 0.0;
    for (const CurvePoint& point : points) {
        if (!std::isfinite(point.x) || !std::isfinite(point.y))
            return std::nullopt;
        meanX += point.x / count;
        meanY += point.y / count;
    }
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
    for (const CurvePoint& point : points) {
        xx += (point.x - meanX) * (point.x - meanX);
        xy += (point.x - meanX) * (point.y - meanY);
        yy += (point.y - meanY) * (point.y - meanY);
    }
    const auto [least, most] =
        std::minmax_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
            return a.x < b.x;
        });
    if (points.empty() || !(least->x < most->x))
        return std::nullopt;
    const double slope = xy / xx;
    return LineFit{slope, meanY - slope * meanX, yy > 0.0 ? xy * xy / (xx * yy) : 1.0};
}

std::optional<PowerFit> fitPower(std::span<const CurvePoint> points) {
    const double count = double(points.size());
    double meanX = 0.0;
    double meanY = 0.0;
    for (const CurvePoint& point : points) {
        if (!(point.x > 0.0) || !(point.y > 0.0))
            return std::nullopt;
        meanX += std::log(point.x) / count;
        meanY += std::log(point.y) / count;
    }
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
    for (const CurvePoint& point : points) {
        const double dx = std::log(point.x) - meanX;
        const double dy = std::log(point.y) - meanY;
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
    }
    const auto [least, most] =
        std::minmax_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
            return a.x < b.x;
        });
    if (points.empty() || !(least->x < most->x))
        return std::nullopt;
    return PowerFit{xy / xx, yy > 0.0 ? xy * xy / (xx * yy) : 1.0, least->x, most->x};
}

Quartiles computeQuartiles(std::vector<double> values) {
    SHUTTER_CHECK(!values.empty(), "quartiles of nothing");
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
        const double position = share * double(values.size() - 1);
        const auto below = static_cast<size_t>(position);
        const size_t above = std::min(below + 1, values.size() - 1);
        return std::lerp(values[below], values[above], position - double(below));
    };
    return {at(0.5), at(0.25), at(0.75)};
}

} // namespace shutter::math
