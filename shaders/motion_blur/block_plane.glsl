// SPDX-License-Identifier: MIT
// The surface in a block of a raster taken as one plane, and where such a plane is seen at an instant.
// `along` (resolved_search.glsl) is linear in a plane's picture: the inverse of the depth before a
// perspective camera, the depth before an orthographic one.
#ifndef SHUTTER_BLOCK_PLANE_GLSL
#define SHUTTER_BLOCK_PLANE_GLSL

#include "common/numeric.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/resolved_shared.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST float kHalfBlockPx = 0.5f * float(kGroupSize);
/// Greatest change of a map's stretch from a block's centre to its sides that still counts as none.
SHUTTER_CONST float kStretchTolerance = 0.02f;
/// Least part of its depth in the raster that a surface has left at an instant: nearer ones count as
/// behind the camera.
SHUTTER_CONST float kMinDepthRatio = 1.0e-4f;

/// Sample positions of a block's pixels in the raster at an instant: place + perX * x + perY * y, x
/// and y from the block's centre.
struct PlaneMap {
    bool isAffine;    // within kStretchTolerance; false: the rest means nothing
    vec2 place;       // in the raster's picture, pixels
    vec2 perX;
    vec2 perY;
    float pxPerAlong; // how far off the place is where the surface is off the plane
    // With a lens alone, at the instant: depth of what the block's centre sees by the middle set, and
    // how much 1 / depth grows per pixel of a pinhole's picture.
    float depth;
    vec2 slope;
};

/// Greatest distance in `along` between two planes within the block of the other.
/// \param centre,otherCentre of their blocks, pixels
SHUTTER_INLINE float
planeGap(BlockPlane plane, vec2 centre, BlockPlane other, vec2 otherCentre) {
    float gap = plane.along + dot(plane.slope, otherCentre - centre) - other.along;
    vec2 turn = abs(plane.slope - other.slope);
    return abs(gap) + kHalfBlockPx * (turn.x + turn.y) + other.deviation;
}

/// \param instantFromRaster of the plane's mover (InstantMotion)
/// \param centre of the plane's block in the raster, pixels
/// \param x the centre of the sampling block at the instant, pixels
SHUTTER_INLINE PlaneMap mapPlane(
    const vec4 instantFromRaster[3], BlockPlane plane, vec2 centre, vec2 x, bool perspective
) {
    // The plane's picture at the instant is a homography of its picture in the raster. Both places
    // count from the centres, which keeps the numbers small.
    vec3 rows[3];
    vec3 perAlong;
    for (int i = 0; i < 3; ++i) {
        vec4 row = instantFromRaster[i];
        float fixed_ = dot(vec2(row), centre) + (perspective ? row.z : row.w);
        perAlong[i] = perspective ? row.w : row.z;
        rows[i] = vec3(row.x, row.y, fixed_);
    }
    if (!perspective) {
        rows[2] = vec3(0.0f, 0.0f, 1.0f);
        perAlong[2] = 0.0f;
    }
    for (int i = 0; i < 3; ++i)
        rows[i] = rows[i] + vec3(plane.slope, plane.along) * perAlong[i];
    for (int i = 0; i < 2; ++i) {
        rows[i] = rows[i] - rows[2] * x[i];
        perAlong[i] -= perAlong[2] * x[i];
    }
    vec3 fromX = cross(rows[1], rows[2]);
    vec3 fromY = cross(rows[2], rows[0]);
    vec3 atCentre = cross(rows[0], rows[1]);
    float scale = 1.0f / atCentre.z;
    vec2 place = vec2(atCentre) * scale;
    PlaneMap map;
    map.perX = (vec2(fromX) - place * fromX.z) * scale;
    map.perY = (vec2(fromY) - place * fromY.z) * scale;
    map.place = centre + place;
    float depthRatio = dot(rows[2], vec3(place, 1.0f));
    map.pxPerAlong =
        length(map.perX * perAlong.x + map.perY * perAlong.y) / max(depthRatio, kMinDepthRatio);
    float stretch = (abs(fromX.z) + abs(fromY.z)) * kHalfBlockPx * abs(scale);
    map.isAffine = stretch <= kStretchTolerance && depthRatio > kMinDepthRatio &&
                   isFinite(dot(map.perX + map.perY, map.perX + map.perY)) &&
                   isFinite(dot(map.place, map.place));
    return map;
}

SHUTTER_SHADER_END

#endif
