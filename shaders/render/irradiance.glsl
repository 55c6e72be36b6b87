// SPDX-License-Identifier: MIT
// Places in equirectangular pictures, and irradiance by spherical harmonics (scene::Environment).
#ifndef SHUTTER_IRRADIANCE_GLSL
#define SHUTTER_IRRADIANCE_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

/// (0.5, 0.5): towards -Z; u to the right, v downwards. \param direction unit
SHUTTER_INLINE vec2 equirectangularPlace(vec3 direction) {
    // atan(0, 0) is undefined in GLSL: straight up and down lie in the middle column.
    bool level = abs(direction.x) + abs(direction.z) > 1.0e-12f;
    float azimuth = level ? atan(direction.x, -direction.z) : 0.0f;
    float polar = acos(clamp(direction.y, -1.0f, 1.0f));
    return vec2(azimuth * 0.15915494f + 0.5f, polar * 0.31830989f);
}

/// Irradiance over pi of a surface; never negative. Ramamoorthi 2001, eq. 13, whose constants the
/// factors hold. \param n the surface's normal, unit
SHUTTER_INLINE vec3 evaluateIrradiance(vec4 factors[9], vec3 n) {
    vec4 sum = factors[0] + n.y * factors[1] + n.z * factors[2] + n.x * factors[3] +
               (n.x * n.y) * factors[4] + (n.y * n.z) * factors[5] +
               (3.0f * n.z * n.z - 1.0f) * factors[6] + (n.x * n.z) * factors[7] +
               (n.x * n.x - n.y * n.y) * factors[8];
    return max(vec3(sum.x, sum.y, sum.z), vec3(0.0f));
}

SHUTTER_SHADER_END

#endif
