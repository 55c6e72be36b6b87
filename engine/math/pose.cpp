// SPDX-License-Identifier: MIT
#include "engine/math/pose.h"

#include "engine/math/transform.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace shutter::math {

namespace {

constexpr int kMostSteps = 32;
constexpr double kArrived = 1.0e-14; ///< of elements of an orthogonal matrix

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
    for (int step = 0; step < kMostSteps; ++step) {
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

} // namespace

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

} // namespace shutter::math
