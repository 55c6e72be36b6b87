// SPDX-License-Identifier: MIT
// Placements of a body between those that are known.
#pragma once

#include "engine/math/math.h"

namespace shutter::math {

/// An affine matrix taken apart: the matrix is translation * rotation * stretch.
struct Pose {
    dmat4 matrix{1.0};
    dvec3 translation{0.0};
    dquat rotation{1.0, 0.0, 0.0, 0.0};
    dmat3 stretch{1.0};     ///< symmetric: scale and shear, mirroring included
    bool isRegular = false; ///< false: the matrix is singular or not finite, and was left whole
};

[[nodiscard]] Pose takeApart(const dmat4& matrix);

/// Between two placements of one body: translation along a straight line, rotation along the
/// shorter arc, stretch linear. A rigid motion about the body's own origin stays one, whatever its
/// scale. Where one of the two is singular or mirrored and the other is not, elements are mixed.
/// \param share [0, 1]; 0 and 1 give the matrices themselves
[[nodiscard]] dmat4 interpolate(const Pose& from, const Pose& to, double share);

} // namespace shutter::math
