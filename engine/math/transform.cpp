// SPDX-License-Identifier: MIT
#include "engine/math/transform.h"

#include <cmath>

namespace shutter::math {

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

dmat4 removeScale(const dmat4& matrix) {
    const double determinant = glm::determinant(dmat3(matrix));
    dmat4 result(1.0);
    result[3] = dvec4(dvec3(matrix[3]), 1.0);
    if (!isFinite(matrix) || !std::isfinite(determinant) || determinant == 0.0)
        return result;
    for (int axis = 0; axis < 3; ++axis) {
        const dvec3 column(matrix[axis]);
        const double size = glm::length(column);
        result[axis] = dvec4(size > 0.0 ? column / size : column, 0.0);
    }
    return result;
}

bool isFinite(const dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row]))
                return false;
    return true;
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
