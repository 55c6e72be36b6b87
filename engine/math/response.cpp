// SPDX-License-Identifier: MIT
#include "engine/math/response.h"

#include "shaders/common/shutter_response.glsl"

#include <algorithm>
#include <vector>

namespace shutter::math {

std::optional<shader::ResponseTable> makeResponseTable(std::span<const ResponsePoint> points) {
    const bool isConstant = std::all_of(points.begin(), points.end(), [&](const auto& point) {
        return point.sensitivity == points.front().sensitivity;
    });
    if (isConstant)
        return std::nullopt;
    // Relative to the largest, so that no sum overflows.
    double largest = 0.0;
    for (const ResponsePoint& point : points)
        largest = std::max(largest, point.sensitivity);
    const auto heightOf = [&](size_t i) { return points[i].sensitivity / largest; };
    std::vector<double> taken{0.0};
    for (size_t i = 1; i < points.size(); ++i)
        taken.push_back(
            taken.back() + (points[i].s - points[i - 1].s) * 0.5 * (heightOf(i) + heightOf(i - 1))
        );
    shader::ResponseTable table{};
    table.knotCount = static_cast<uint32_t>(points.size());
    for (size_t i = 0; i < points.size(); ++i)
        table.knots[i] = {
            static_cast<float>(points[i].s),
            static_cast<float>(heightOf(i) / taken.back()),
            static_cast<float>(taken[i] / taken.back()),
            0.0f};
    shader::fillFirstKnots(table);
    return table;
}

} // namespace shutter::math
