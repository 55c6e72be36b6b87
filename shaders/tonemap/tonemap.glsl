// SPDX-License-Identifier: MIT
// Khronos PBR Neutral tone mapper (Khronos, 2024) and the sRGB transfer function (IEC 61966-2-1).
#ifndef SHUTTER_TONEMAP_GLSL
#define SHUTTER_TONEMAP_GLSL

#include "common/numeric.glsl"
#include "common/transfer.glsl"

SHUTTER_SHADER_BEGIN

/// Keeps colours up to 0.8 but for a small offset (Fresnel's 0.04), rolls brighter ones off towards
/// white. Result in [0, 1].
SHUTTER_INLINE vec3 toneMapNeutral(vec3 color) {
    const float startCompression = 0.8f - 0.04f;
    const float desaturation = 0.15f;
    float x = min(color.x, min(color.y, color.z));
    float offset = x < 0.08f ? x - 6.25f * x * x : 0.04f;
    vec3 c = color - vec3(offset);
    float peak = max(c.x, max(c.y, c.z));
    if (peak < startCompression) return c;
    float d = 1.0f - startCompression;
    float newPeak = 1.0f - d * d / (peak + d - startCompression);
    c *= newPeak / peak;
    float g = 1.0f - 1.0f / (desaturation * (peak - newPeak) + 1.0f);
    return mix(c, vec3(newPeak), g);
}

SHUTTER_INLINE float encodeSrgb(float x) {
    return encodeSrgbCurve(saturate(x));
}

SHUTTER_INLINE vec3 encodeSrgb3(vec3 c) {
    return vec3(encodeSrgb(c.x), encodeSrgb(c.y), encodeSrgb(c.z));
}

SHUTTER_SHADER_END

#endif
