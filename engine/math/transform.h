// SPDX-License-Identifier: MIT
#pragma once

#include "engine/math/math.h"

namespace shutter::math {

/// Translation, rotation and scale, applied in the order scale, rotation, translation (glTF).
struct Transform {
    dvec3 translation{0.0};             ///< metres
    dquat rotation{1.0, 0.0, 0.0, 0.0}; ///< unit quaternion (w, x, y, z)
    dvec3 scale{1.0};                   ///< per axis; 0 and negative values are allowed
};

/// Matrix that takes the transform's local space to its parent's.
[[nodiscard]] dmat4 computeMatrix(const Transform& transform);

/// Rotation by `angularVelocity` (rad/s, axis in the parent space) kept up for `seconds`.
/// Exact at zero velocity: returns the identity.
[[nodiscard]] dquat integrateRotation(const dvec3& angularVelocity, double seconds);

/// The matrix with axes of length 1: where it stands and how it is turned. One that is not finite
/// or is scaled to nothing keeps its place only and is turned as the space around it.
[[nodiscard]] dmat4 removeScale(const dmat4& matrix);

/// True when every element is finite.
[[nodiscard]] bool isFinite(const dmat4& matrix);

} // namespace shutter::math
