// SPDX-License-Identifier: MIT
// The ray of a pixel at an instant, as places in a layer's picture.
#ifndef SHUTTER_PIXEL_RAY_GLSL
#define SHUTTER_PIXEL_RAY_GLSL

#include "motion_blur/resolved.glsl"

/// A pixel's ray at an instant in the layer's picture: the point at a depth is seen at the projection
/// of base + slope * along. `along` is what places on the ray's picture are evenly spaced by: the
/// inverse of the depth before a perspective camera, the depth before an orthographic one.
struct PixelRay {
    vec3 base;
    vec3 slope;
};

PixelRay findRay(vec4 rasterFromInstant[3], vec2 x, bool perspective) {
    vec3 at = vec3(x, 1.0f);
    vec3 inDepth = vec3(
        dot(rasterFromInstant[0].xyz, at), dot(rasterFromInstant[1].xyz, at),
        dot(rasterFromInstant[2].xyz, at)
    );
    vec3 fixed_ = vec3(rasterFromInstant[0].w, rasterFromInstant[1].w, rasterFromInstant[2].w);
    if (perspective) return PixelRay(inDepth, fixed_);
    vec3 perDepth = vec3(rasterFromInstant[0].z, rasterFromInstant[1].z, rasterFromInstant[2].z);
    return PixelRay(inDepth - perDepth + fixed_, perDepth);
}

float alongOf(float depth, bool perspective) {
    return perspective ? 1.0f / max(depth, kMinDepth) : depth;
}

vec2 placeOn(PixelRay ray, float along, bool perspective) {
    return projectPicture(ray.base + ray.slope * along, perspective);
}

#endif
