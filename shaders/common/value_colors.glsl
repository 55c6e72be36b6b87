// SPDX-License-Identifier: MIT
// Values as colours that a person can read; display-encoded, [0, 1].
#ifndef SHUTTER_VALUE_COLORS_GLSL
#define SHUTTER_VALUE_COLORS_GLSL

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Hue [0, 1) at full saturation.
SHUTTER_INLINE vec3 hueColor(float hue) {
    vec3 ramp = abs(fract(vec3(hue) + vec3(0.0f, 2.0f / 3.0f, 1.0f / 3.0f)) * 6.0f - vec3(3.0f));
    return clamp(ramp - vec3(1.0f), vec3(0.0f), vec3(1.0f));
}

/// Right is red, down (positive y) is yellow-green, left cyan, up violet; longer is brighter, by the
/// square root so that small motions are seen.
SHUTTER_INLINE vec3 motionColor(vec2 motionPx, float longestPx) {
    float lengthPx = length(motionPx);
    if (!(lengthPx > 0.0f)) return vec3(0.0f);
    float hue = fract(atan(motionPx.y, motionPx.x) / 6.28318531f + 1.0f);
    return hueColor(hue) * sqrt(clamp(lengthPx / longestPx, 0.0f, 1.0f));
}

/// White at 10 cm, black at 10 km and for the sky.
SHUTTER_INLINE vec3 depthColor(float metres) {
    if (!(metres > 0.0f)) return vec3(1.0f);
    return vec3(clamp(0.8f - 0.2f * log2(metres) / 3.32192809f, 0.0f, 1.0f));
}

/// Ids that follow on each other get colours far apart (the golden ratio's hues).
SHUTTER_INLINE vec3 idColor(uint id) {
    float hue = fract(float(id % 4096u) * 0.61803399f);
    float value = 0.55f + 0.45f * fract(float(id % 4093u) * 0.75487767f);
    return mix(vec3(1.0f), hueColor(hue), 0.75f) * value;
}

/// Black, blue, red, yellow, white at equal distances of [0, 1].
SHUTTER_INLINE vec3 heatColor(float share) {
    float x = clamp(share, 0.0f, 1.0f) * 4.0f;
    if (x < 1.0f) return vec3(0.0f, 0.0f, x);
    if (x < 2.0f) return vec3(x - 1.0f, 0.0f, 2.0f - x);
    if (x < 3.0f) return vec3(1.0f, x - 2.0f, 0.0f);
    return vec3(1.0f, 1.0f, x - 3.0f);
}

SHUTTER_SHADER_END

#endif
