// SPDX-License-Identifier: MIT
// Picture space (instant_motion_shared.h): to it, through an affine map, and back to the picture.
#ifndef SHUTTER_PICTURE_SPACE_GLSL
#define SHUTTER_PICTURE_SPACE_GLSL

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// \param at place in the picture, pixels
SHUTTER_INLINE vec4 pictureSpace(vec2 at, float depth, bool perspective) {
    return vec4(at * (perspective ? depth : 1.0f), depth, 1.0f);
}

SHUTTER_INLINE vec3 transformRows(vec4 rows[3], vec4 point) {
    return vec3(dot(rows[0], point), dot(rows[1], point), dot(rows[2], point));
}

/// Nearest depth that counts as in front of a perspective camera, metres.
SHUTTER_CONST float kMinDepth = 1.0e-6f;

SHUTTER_INLINE vec2 projectPicture(vec3 point, bool perspective) {
    vec2 at = vec2(point.x, point.y);
    return perspective ? at * (1.0f / max(point.z, kMinDepth)) : at;
}

SHUTTER_SHADER_END

#endif
