// SPDX-License-Identifier: MIT
// Draws the per-pixel motion of a raster's deforming entities over the exposure
// (common/pixel_way.glsl).
#ifndef SHUTTER_SHAPE_WAYS_SHARED_H
#define SHUTTER_SHAPE_WAYS_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// One deforming entity of a raster. The last four are rows of maps to (x q, y q, q, depth), where
/// x and y are places in the picture of that time, pixels, and q is the depth (perspective) or 1.
struct ShapeWayRow {
    mat4 clipFromObject; // as the raster was drawn
    vec4 raster[4];
    vec4 open[3];
    vec4 middle[3];
    vec4 close[3];
};

/// Push constants: one geometry of one entity. Addresses of vec4[] whose xyz are places in object
/// space; a stride is how many vec4 a vertex has.
struct ShapeWayDraw {
    uvec2 row; // address of its ShapeWayRow
    uvec2 rasterPositions;
    uvec2 openPositions;
    uvec2 middlePositions;
    uvec2 closePositions;
    uint rasterStride;
    uint exposureStride; // of the other three
    uint key;            // of the entity in the image of surfaces
    uint keyMask;        // of that image's second word
    float leastQ;        // in front of the camera
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::ShapeWayRow) == 272);
static_assert(sizeof(shutter::shader::ShapeWayDraw) == 60);
#endif

#endif
