// SPDX-License-Identifier: MIT
#include "engine/math/transform.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace shutter::math {

namespace {

constexpr int kMaxSteps = 32;
constexpr double kArrived = 1.0e-14; ///< of elements of an orthogonal matrix
/// Sine of the shear that rounded files and products have: axes so square are left as they are.
constexpr double kSquare = 1.0e-6;
/// Sine of the angle between axes that count as parallel.
constexpr double kParallel = 1.0e-9;
/// Squares of elements within [1 / kPlain, kPlain] neither overflow nor vanish.
constexpr double kPlain = 1.0e100;

double largestElement(const dmat3& matrix) {
    double largest = 0.0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(matrix[column][row]));
    return largest;
}

bool isFinite(const dmat3& matrix) {
    return math::isFinite(dmat4(matrix));
}

/// The orthogonal factor of the polar decomposition, by Newton's iteration with scaling by the
/// determinant (Higham 1986, "Computing the polar decomposition"). Nothing: it has none.
std::optional<dmat3> findOrthogonal(const dmat3& matrix) {
    const double size = largestElement(matrix);
    if (!(size > 0.0) || !isFinite(matrix))
        return std::nullopt;
    dmat3 x = matrix / size; // so that determinants neither overflow nor vanish
    for (int step = 0; step < kMaxSteps; ++step) {
        const double determinant = std::abs(glm::determinant(x));
        if (!(determinant > 0.0))
            return std::nullopt;
        const double scale = 1.0 / std::cbrt(determinant);
        const dmat3 next = 0.5 * (x * scale + glm::inverse(glm::transpose(x)) / scale);
        if (!isFinite(next))
            return std::nullopt;
        const double change = largestElement(next - x);
        x = next;
        if (change < kArrived)
            break;
    }
    return x;
}

dvec3 normalizeOrZero(const dvec3& vector) {
    const double size = glm::length(vector);
    return size > 0.0 ? vector / size : dvec3(0.0);
}

/// Whether axes of length 1 or 0 are at right angles and not mirrored.
bool isRightHanded(const dmat3& axes) {
    const double shear = std::max(
        {std::abs(glm::dot(axes[0], axes[1])),
         std::abs(glm::dot(axes[1], axes[2])),
         std::abs(glm::dot(axes[2], axes[0]))}
    );
    return shear <= kSquare && glm::dot(glm::cross(axes[0], axes[1]), axes[2]) > 0.5;
}

/// The nearest right-handed axes that keep z, and y on its side of it (Gram and Schmidt).
std::optional<dmat3> standUpright(const dmat3& axes) {
    dvec3 back = axes[2];
    if (back == dvec3(0.0))
        back = normalizeOrZero(glm::cross(axes[0], axes[1]));
    dvec3 up = axes[1] - back * glm::dot(axes[1], back);
    if (!(glm::length(up) > kParallel))
        up = glm::cross(back, axes[0]);
    if (back == dvec3(0.0) || !(glm::length(up) > kParallel))
        return std::nullopt;
    up = glm::normalize(up);
    return dmat3(glm::cross(up, back), up, back);
}

} // namespace

dmat4 computeMatrix(const Transform& transform) {
    dmat4 matrix = glm::mat4_cast(transform.rotation);
    matrix[0] *= transform.scale.x;
    matrix[1] *= transform.scale.y;
    matrix[2] *= transform.scale.z;
    matrix[3] = dvec4(transform.translation, 1.0);
    return matrix;
}

dquat integrateRotation(const dvec3& angularVelocity, double seconds) {
    const double speed = glm::length(angularVelocity);
    if (!(speed > 0.0))
        return dquat(1.0, 0.0, 0.0, 0.0);
    return glm::angleAxis(speed * seconds, angularVelocity / speed);
}

std::optional<dmat4> findRigid(const dmat4& matrix) {
    dmat3 axes(matrix);
    const double largest = largestElement(axes);
    if (!isFinite(matrix) || !(largest > 0.0))
        return std::nullopt;
    if (largest > kPlain || largest < 1.0 / kPlain)
        axes /= largest;
    for (int axis = 0; axis < 3; ++axis)
        axes[axis] = normalizeOrZero(axes[axis]);
    if (!isRightHanded(axes)) {
        const auto upright = standUpright(axes);
        if (!upright)
            return std::nullopt;
        axes = *upright;
    }
    dmat4 rigid(axes);
    rigid[3] = dvec4(dvec3(matrix[3]), 1.0);
    return rigid;
}

dmat4 removeScale(const dmat4& matrix) {
    if (const std::optional<dmat4> rigid = findRigid(matrix))
        return *rigid;
    return glm::translate(dmat4(1.0), dvec3(matrix[3]));
}

bool isFinite(const dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row]))
                return false;
    return true;
}

Pose takeApart(const dmat4& matrix) {
    Pose pose;
    pose.matrix = matrix;
    pose.translation = dvec3(matrix[3]);
    const dmat3 linear(matrix);
    const std::optional<dmat3> orthogonal = findOrthogonal(linear);
    if (!orthogonal || !math::isFinite(matrix))
        return pose;
    // In three dimensions a mirroring is a rotation and a reflection through the origin.
    const dmat3 turn = glm::determinant(*orthogonal) < 0.0 ? -*orthogonal : *orthogonal;
    pose.rotation = glm::normalize(glm::quat_cast(turn));
    pose.stretch = glm::transpose(turn) * linear;
    pose.isRegular = true;
    return pose;
}

dmat4 interpolate(const Pose& from, const Pose& to, double share) {
    if (share <= 0.0)
        return from.matrix;
    if (share >= 1.0)
        return to.matrix;
    const bool mirrors =
        (glm::determinant(from.stretch) < 0.0) != (glm::determinant(to.stretch) < 0.0);
    if (!from.isRegular || !to.isRegular || mirrors)
        return from.matrix * (1.0 - share) + to.matrix * share;
    // glm::slerp takes the shorter of the two arcs.
    const dquat rotation = glm::normalize(glm::slerp(from.rotation, to.rotation, share));
    const dmat3 stretch = from.stretch * (1.0 - share) + to.stretch * share;
    dmat4 matrix(glm::mat3_cast(rotation) * stretch);
    matrix[3] = dvec4(glm::mix(from.translation, to.translation, share), 1.0);
    return matrix;
}

dmat4 clipFromViewPerspective(double yFov, double aspect, double near) {
    const double focal = 1.0 / std::tan(yFov / 2.0);
    dmat4 clip(0.0);
    clip[0][0] = focal / aspect;
    clip[1][1] = -focal;
    clip[2][3] = -1.0; // w = -z: distance along the view direction
    clip[3][2] = near; // z = near, so z / w = near / distance
    return clip;
}

dmat4 clipFromViewOrthographic(double xMag, double yMag, double near, double far) {
    dmat4 clip(0.0);
    clip[0][0] = 1.0 / xMag;
    clip[1][1] = -1.0 / yMag;
    clip[2][2] = 1.0 / (far - near); // distance = -z: (far - distance) / (far - near)
    clip[3][2] = far / (far - near);
    clip[3][3] = 1.0;
    return clip;
}

} // namespace shutter::math
