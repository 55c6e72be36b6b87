// SPDX-License-Identifier: MIT
#include "engine/math/projection.h"

#include <cmath>

namespace shutter::math {

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
