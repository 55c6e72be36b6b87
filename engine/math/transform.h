// SPDX-License-Identifier: MIT
// Transforms and projections, the matrices made of them, and matrices taken apart again: placements
// of a body between those that are known.
#pragma once

#include "engine/math/math.h"

#include <optional>

namespace shutter::math {

/// Translation, rotation and scale, applied in the order scale, rotation, translation (glTF).
struct Transform {
    dvec3 translation{0.0};             ///< metres
    dquat rotation{1.0, 0.0, 0.0, 0.0}; ///< unit quaternion (w, x, y, z)
    dvec3 scale{1.0};                   ///< per axis; 0 and negative values are allowed
};

/// Matrix that takes the transform's local space to its parent's.
[[nodiscard]] dmat4 computeMatrix(const Transform& transform);

/// Rotation after turning at `angularVelocity` (rad/s, axis in the parent space) for `seconds`.
/// Exact at zero velocity: returns the identity.
[[nodiscard]] dquat integrateRotation(const dvec3& angularVelocity, double seconds);

/// Position and orientation of a camera or light (forward -Z, up +Y) without scale, shear and
/// mirroring: -Z preserves its direction and +Y its side of it; +X makes the axes right-handed. If
/// one of the three has no length, the two others determine it. Nothing: the matrix is not finite,
/// or has no two directions.
[[nodiscard]] std::optional<dmat4> findRigid(const dmat4& matrix);

/// findRigid(); a matrix that has none keeps its translation and gets the identity as rotation.
[[nodiscard]] dmat4 removeScale(const dmat4& matrix);

/// True when every element is finite.
[[nodiscard]] bool isFinite(const dmat4& matrix);

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

/// Perspective with reversed depth and the far plane at infinity: clip depth is near / distance,
/// so a float depth buffer keeps its relative precision at every distance. Clip w is the distance
/// along the view direction. y points down (Vulkan).
/// \param yFov vertical field of view in radians, in (0, pi)
/// \param aspect width / height, above 0
/// \param near distance of the near plane in metres, above 0
[[nodiscard]] dmat4 clipFromViewPerspective(double yFov, double aspect, double near);

/// Orthographic with reversed depth: 1 at `near`, 0 at `far`; clip w is 1.
/// \param xMag, yMag half width and half height of the view in metres, not 0; below 0 mirrors
[[nodiscard]] dmat4 clipFromViewOrthographic(double xMag, double yMag, double near, double far);

} // namespace shutter::math
