// SPDX-License-Identifier: MIT
#include "engine/image/metric_parts.h"

#include "engine/core/check.h"

#include <algorithm>

namespace shutter::image {

namespace {

void checkFilter(const Plane& plane, const Kernel& kernel) {
    SHUTTER_CHECK_EQ(plane.values.size(), size_t(plane.width) * plane.height);
    SHUTTER_CHECK(kernel.size() % 2 == 1, "{} weights", kernel.size());
}

/// Offset by offset over a whole row, not pixel by pixel: the compiler vectorises this loop.
void addWeighted(const float* source, float weight, float* sum, size_t count) {
    for (size_t i = 0; i < count; ++i)
        sum[i] += weight * source[i];
}

} // namespace

Plane filterAlongX(const Plane& plane, const Kernel& kernel) {
    checkFilter(plane, kernel);
    const size_t radius = kernel.size() / 2;
    const size_t width = plane.width;
    Plane result(plane.width, plane.height);
    if (result.values.empty())
        return result;
    std::vector<float> padded(width + 2 * radius);
    for (size_t y = 0; y < plane.height; ++y) {
        const float* row = plane.values.data() + y * width;
        std::fill_n(padded.begin(), radius, row[0]);
        std::copy_n(row, width, padded.data() + radius);
        std::fill_n(padded.data() + radius + width, radius, row[width - 1]);
        for (size_t tap = 0; tap < kernel.size(); ++tap)
            addWeighted(padded.data() + tap, kernel[tap], result.values.data() + y * width, width);
    }
    return result;
}

Plane filterAlongY(const Plane& plane, const Kernel& kernel) {
    checkFilter(plane, kernel);
    const auto radius = std::ptrdiff_t(kernel.size() / 2);
    const size_t width = plane.width;
    const auto lastRow = std::ptrdiff_t(plane.height) - 1;
    Plane result(plane.width, plane.height);
    for (std::ptrdiff_t y = 0; y <= lastRow; ++y)
        for (size_t tap = 0; tap < kernel.size(); ++tap) {
            const auto from =
                std::clamp<std::ptrdiff_t>(y + std::ptrdiff_t(tap) - radius, 0, lastRow);
            addWeighted(
                plane.values.data() + size_t(from) * width,
                kernel[tap],
                result.values.data() + size_t(y) * width,
                width
            );
        }
    return result;
}

} // namespace shutter::image
