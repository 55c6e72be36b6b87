// SPDX-License-Identifier: MIT
// Continues a ray from a surface without hitting it again and without missing surfaces close behind
// it. No offset achieves both: one that exceeds the error of the hit skips surfaces within it, and
// at a kilometre that error is millimetres. So the ray starts in front of the surface, and hits of
// the same entity within the error are that surface.
#ifndef SHUTTER_MOTION_BLUR_NEXT_SURFACE_GLSL
#define SHUTTER_MOTION_BLUR_NEXT_SURFACE_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

/// Error of a distance along a ray, as a share of it: 32 float steps, more than the sum of the
/// errors of the intersection and of the transforms into the entity's space and back.
SHUTTER_CONST float kRayError = 3.8e-6f;

/// Error, metres, of a distance that a ray found.
SHUTTER_INLINE float rayHitError(float distance_) { return kRayError * distance_; }

/// Error, metres, of a distance that raster found. Raster moves corners to a grid of 1/256 pixel, and
/// a surface seen at a slant moves in depth by that times its slope: a pixel's width covers slopes
/// up to 256, which all but the last rim of a silhouette keep within.
/// \param pixelFootprint width of a pixel: x at distance 1, y at any
SHUTTER_INLINE float rasterHitError(float distance_, vec2 pixelFootprint) {
    return rayHitError(distance_) + pixelFootprint.x * distance_ + pixelFootprint.y;
}

SHUTTER_SHADER_END

#endif
