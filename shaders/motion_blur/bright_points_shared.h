// SPDX-License-Identifier: MIT
// Bright points out of focus, which are drawn as discs (bright_points.glsl).
#ifndef SHUTTER_BRIGHT_POINTS_SHARED_H
#define SHUTTER_BRIGHT_POINTS_SHARED_H

#include "motion_blur/motion_blur_shared.h"

SHUTTER_SHADER_BEGIN

/// Side of the square of pixels of which one point is made, pixels.
SHUTTER_CONST uint kPointTilePx = 4u;
/// Side of a region: kGroupSize x kGroupSize such squares.
SHUTTER_CONST uint kPointRegionPx = kPointTilePx * kGroupSize;
/// Maximum number of points of a region, which bounds the discs that a pixel may lie in.
SHUTTER_CONST uint kMaxRegionPoints = 8u;
/// Work groups in a row of the dispatch over listed regions: devices may allow no more than 65,535
/// along an axis.
SHUTTER_CONST uint kRegionRow = 1024u;
/// Luminance by which a point exceeds what is around it.
SHUTTER_CONST float kMinPointLight = 1.0f;
/// Alpha of a pixel whose point was taken out of the layer.
SHUTTER_CONST float kTakenOutAlpha = -1.0f;

/// Pixels of one surface that are brighter than those around by more than samples can spread.
struct BrightPoint {
    vec2 at;       // their centre in this frame's raster, pixels
    float along;   // 1 / depth, 1/metre; 0: the sky
    uint mover;    // in the table of movers
    vec3 light;    // by which they exceed what replaces them, summed over them
    float widthPx; // over which the disc's border rises at a place (shareOfDisc())
    vec2 low;      // bounds of what the disc touches at any instant, pixels
    vec2 high;
    uint instants; // that it is drawn at
};

/// Head of the buffer of counts; the number of points of each region follows.
struct PointHeader {
    uint reachPx; // greatest distance of a disc's bounds from its point
};

/// Head of the list of regions that hold a pixel of more than kMinPointLight; their indices follow.
struct RegionHeader {
    uint count;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::BrightPoint) == 52);
static_assert(sizeof(shutter::shader::PointHeader) == 4);
static_assert(sizeof(shutter::shader::RegionHeader) == 4);
#endif

#endif
