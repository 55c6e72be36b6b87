// SPDX-License-Identifier: MIT
#pragma once

#include "engine/math/math.h"

#include <limits>

namespace shutter::math {

/// Axis-aligned box; empty until a point is added.
struct Bounds {
    dvec3 min{std::numeric_limits<double>::infinity()};
    dvec3 max{-std::numeric_limits<double>::infinity()};

    [[nodiscard]] bool isEmpty() const { return !(min.x <= max.x); }

    void add(const dvec3& point);
    void add(const Bounds& other);

    [[nodiscard]] dvec3 centre() const { return (min + max) * 0.5; }

    [[nodiscard]] dvec3 size() const { return max - min; }
};

/// Box around the eight transformed corners; empty stays empty.
[[nodiscard]] Bounds transformBounds(const dmat4& matrix, const Bounds& bounds);

} // namespace shutter::math
