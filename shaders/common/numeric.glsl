// SPDX-License-Identifier: MIT
#ifndef SHUTTER_NUMERIC_GLSL
#define SHUTTER_NUMERIC_GLSL

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_INLINE float saturate(float x) { return clamp(x, 0.0f, 1.0f); }

/// Relative luminance of linear Rec. 709.
SHUTTER_INLINE float luminance(vec3 color) {
    return dot(color, vec3(0.2126f, 0.7152f, 0.0722f));
}

/// False for NaN and infinity. Tests the bits: a Vulkan compiler may assume that there are none,
/// and remove a comparison that tests for them.
SHUTTER_INLINE bool isFinite(float x) { return (floatBitsToUint(x) & 0x7F800000u) != 0x7F800000u; }

/// True for NaN alone. Tests the bits, for the same reason.
SHUTTER_INLINE bool isNotANumber(float x) {
    return (floatBitsToUint(x) & 0x7FFFFFFFu) > 0x7F800000u;
}

/// Largest value a colour may have: half floats end at 65504.
SHUTTER_CONST float kMaxColor = 65000.0f;

/// A colour that a half-float image can hold: NaN becomes 0, infinity and overflow become kMaxColor.
SHUTTER_INLINE vec3 storableColor(vec3 color) {
    vec3 result = min(max(color, vec3(0.0f)), vec3(kMaxColor));
    // GLSL leaves min and max of NaN undefined, so each channel is tested.
    if (isNotANumber(color.x)) result.x = 0.0f;
    if (isNotANumber(color.y)) result.y = 0.0f;
    if (isNotANumber(color.z)) result.z = 0.0f;
    return result;
}

SHUTTER_SHADER_END

#endif
