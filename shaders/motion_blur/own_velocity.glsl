// SPDX-License-Identifier: MIT
#ifndef SHUTTER_MOTION_BLUR_OWN_VELOCITY_GLSL
#define SHUTTER_MOTION_BLUR_OWN_VELOCITY_GLSL

#include "motion_blur/taps.glsl"

SHUTTER_SHADER_BEGIN

/// No tile bounds a pixel's own motion; this does: beyond every screen, and taps stay exact to 1/100
/// pixel.
SHUTTER_CONST float kLongestOwnMotionPx = 65536.0f;

/// Bevy's occluder test: whether a tap that is not behind the pixel moves far enough along `offset`
/// to have been over it. Bevy compares half the motion, projected, with the distance: the centred
/// exposure of this.
SHUTTER_INLINE bool couldCover(vec2 offset, vec2 tapMotion, float rasterTime) {
    float projected = abs(dot(offset, tapMotion)) * reachShare(offset, tapMotion, rasterTime);
    return projected >= dot(offset, offset);
}

SHUTTER_SHADER_END

#endif
