// SPDX-License-Identifier: MIT
// A ray and a triangle, watertight: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle
// Intersection". A ray through an edge or a corner meets each triangle that has it.
#ifndef SHUTTER_RAY_TRIANGLE_GLSL
#define SHUTTER_RAY_TRIANGLE_GLSL

#include "common/numeric.glsl"

#ifdef __cplusplus
#define SHUTTER_PRECISE
#else
// Both triangles of an edge must round alike: no fused multiply-add in one of them only.
#define SHUTTER_PRECISE precise
#endif

SHUTTER_SHADER_BEGIN

struct TriangleHit {
    bool found;
    float t;           // in lengths of the direction; any sign
    vec2 barycentrics; // of the second and third vertex
    bool frontFace;    // the vertices run counter-clockwise as the ray sees them
};

/// The vector with the direction's largest axis as z; cyclic, so that handedness stays.
SHUTTER_INLINE vec3 turnAxes(vec3 v, vec3 direction) {
    vec3 size = abs(direction);
    if (size.x > size.y && size.x > size.z) return vec3(v.y, v.z, v.x);
    if (size.y > size.z) return vec3(v.z, v.x, v.y);
    return v;
}

/// \param direction any length; zero, NaN and infinity meet nothing
SHUTTER_INLINE TriangleHit
intersectTriangle(vec3 origin, vec3 direction, vec3 first, vec3 second, vec3 third) {
    vec3 along = turnAxes(direction, direction);
    vec3 a = turnAxes(first - origin, direction);
    vec3 b = turnAxes(second - origin, direction);
    vec3 c = turnAxes(third - origin, direction);
    // The ray becomes the z axis.
    float shearX = along.x / along.z;
    float shearY = along.y / along.z;
    SHUTTER_PRECISE float ax = a.x - shearX * a.z;
    SHUTTER_PRECISE float ay = a.y - shearY * a.z;
    SHUTTER_PRECISE float bx = b.x - shearX * b.z;
    SHUTTER_PRECISE float by = b.y - shearY * b.z;
    SHUTTER_PRECISE float cx = c.x - shearX * c.z;
    SHUTTER_PRECISE float cy = c.y - shearY * c.z;
    // Twice the areas the ray's point makes with each edge, turned round.
    SHUTTER_PRECISE float u = cx * by - cy * bx;
    SHUTTER_PRECISE float v = ax * cy - ay * cx;
    SHUTTER_PRECISE float w = bx * ay - by * ax;
    float determinant = u + v + w;

    TriangleHit hit;
    hit.t = (u * a.z + v * b.z + w * c.z) / (determinant * along.z);
    hit.barycentrics = vec2(v, w) / determinant;
    hit.frontFace = determinant * along.z > 0.0f;
    bool inside = (u >= 0.0f && v >= 0.0f && w >= 0.0f) || (u <= 0.0f && v <= 0.0f && w <= 0.0f);
    hit.found = inside && determinant != 0.0f && isFinite(hit.t) && isFinite(along.z);
    return hit;
}

SHUTTER_SHADER_END

#endif
