// SPDX-License-Identifier: MIT
// The edge measure of the ray mask (Tan et al., "Ray Mask").
#ifndef SHUTTER_MOTION_BLUR_RAY_MASK_GLSL
#define SHUTTER_MOTION_BLUR_RAY_MASK_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

/// Smoothing and derivative parts of the separable 5x5 Sobel operator, offset -2 ... 2.
SHUTTER_INLINE float sobelSmooth(int offset) {
    int distance_ = offset < 0 ? -offset : offset;
    return distance_ == 0 ? 6.0f : distance_ == 1 ? 4.0f : 1.0f;
}

SHUTTER_INLINE float sobelDerive(int offset) {
    int distance_ = offset < 0 ? -offset : offset;
    float size = distance_ == 0 ? 0.0f : distance_ == 1 ? 2.0f : 1.0f;
    return offset < 0 ? -size : size;
}

/// x_n = saturate(1 - 1 / (x + 1)) with x = delta_d + delta_n: [0, 1), 0 without any edge.
/// \param depthGradient depth's horizontal and vertical Sobel response, metres
/// \param normalX, normalY the normal's
SHUTTER_INLINE float edgeMeasure(vec2 depthGradient, vec3 normalX, vec3 normalY) {
    float normalGradient = sqrt(dot(normalX, normalX) + dot(normalY, normalY));
    float x = length(depthGradient) + normalGradient;
    return saturate(1.0f - 1.0f / (x + 1.0f));
}

SHUTTER_SHADER_END

#endif
