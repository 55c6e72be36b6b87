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

bool isFinite(const dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row]))
                return false;
    return true;
}

} // namespace shutter::math
