// SPDX-License-Identifier: MIT
// Motion of a surface point in the picture, from where it is projected at shutter open and close.
#ifndef SHUTTER_MOTION_GLSL
#define SHUTTER_MOTION_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

/// Longest motion that is stored, pixels: finite in every later sum, longer than any picture.
SHUTTER_CONST float kMaxMotionPx = 32768.0f;

/// Pixels from the top left corner. `clip` is x, y, w of clip space, w > 0.
SHUTTER_INLINE vec2 screenFromClip(vec3 clip, vec2 sizePx) {
    return (vec2(clip.x, clip.y) / clip.z * 0.5f + 0.5f) * sizePx;
}

/// A point that passed behind the near plane during the exposure has no projection there. It is
/// taken back along its path towards `visible`, which lies in front, to where it was last in front.
SHUTTER_INLINE vec3 pullInFront(vec3 clip, vec3 visible, float minW) {
    if (clip.z >= minW) return clip;
    float t = saturate((visible.z - minW) / max(visible.z - clip.z, 1.0e-20f));
    // The cut is where w is minW: the difference of two far larger values would be inaccurate.
    return vec3(mix(vec2(visible.x, visible.y), vec2(clip.x, clip.y), t), minW);
}

/// Displacement over the whole exposure in pixels (right, down), open to close.
/// \param open, close, visible x, y, w of clip space at open, close and the raster instant
/// \param minW clip w of the near plane
SHUTTER_INLINE vec2 motionFromClip(vec3 open, vec3 close, vec3 visible, float minW, vec2 sizePx) {
    vec2 from = screenFromClip(pullInFront(open, visible, minW), sizePx);
    vec2 to = screenFromClip(pullInFront(close, visible, minW), sizePx);
    vec2 motion = to - from;
    float speed = length(motion);
    if (!isFinite(speed)) return vec2(0.0f);
    if (speed > kMaxMotionPx) motion *= kMaxMotionPx / speed;
    return motion;
}

SHUTTER_SHADER_END

#endif
