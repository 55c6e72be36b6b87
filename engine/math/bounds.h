// SPDX-License-Identifier: MIT
// Bounding boxes in the space and unit of their points: object, world or view space, metres.
#pragma once

#include "engine/math/math.h"

#include <limits>

namespace shutter::math {

/// Axis-aligned box; empty until a point is added.
struct Bounds {
    dvec3 min{std::numeric_limits<double>::infinity()};
    dvec3 max{-std::numeric_limits<double>::infinity()};

    [[nodiscard]] bool isEmpty() const { return !(min.x <= max.x); }

    /// Grows to hold the point, which is to be finite: a NaN would be passed over.
    void add(const dvec3& point);
    /// Grows to hold the other box; an empty one changes nothing.
    void add(const Bounds& other);

    /// The middle of the box; NaN if it is empty.
    [[nodiscard]] dvec3 centre() const { return (min + max) * 0.5; }

    /// Edge lengths, 0 or more; minus infinity if the box is empty.
    [[nodiscard]] dvec3 size() const { return max - min; }
};

/// Box around the eight transformed corners, so larger than its contents if `matrix` rotates; empty
/// stays empty. \param matrix affine
[[nodiscard]] Bounds transformBounds(const dmat4& matrix, const Bounds& bounds);

/// Whether no component's magnitude exceeds `limit`; false if one is NaN.
[[nodiscard]] bool isWithin(const dvec3& value, double limit);

} // namespace shutter::math
