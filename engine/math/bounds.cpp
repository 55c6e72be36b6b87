// SPDX-License-Identifier: MIT
#include "engine/math/bounds.h"

#include <cmath>

namespace shutter::math {

void Bounds::add(const dvec3& point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
}

void Bounds::add(const Bounds& other) {
    if (other.isEmpty())
        return;
    add(other.min);
    add(other.max);
}

Bounds transformBounds(const dmat4& matrix, const Bounds& bounds) {
    Bounds result;
    if (bounds.isEmpty())
        return result;
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 point(
            corner & 1 ? bounds.max.x : bounds.min.x,
            corner & 2 ? bounds.max.y : bounds.min.y,
            corner & 4 ? bounds.max.z : bounds.min.z
        );
        result.add(dvec3(matrix * dvec4(point, 1.0)));
    }
    return result;
}

bool isWithin(const dvec3& value, double limit) {
    return std::abs(value.x) <= limit && std::abs(value.y) <= limit && std::abs(value.z) <= limit;
}

} // namespace shutter::math
