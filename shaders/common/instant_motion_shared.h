// SPDX-License-Identifier: MIT
// Motion of the surfaces of a raster image to other instants of the exposure. A mover is a rigid
// body with its own motion; everything static in the world is one mover, the sky another.
//
// Picture space at a time is (x q, y q, depth, 1): x, y pixels from the top left corner, depth
// metres along the view direction, q the depth (perspective) or 1 (orthographic). Rigid motion, the
// camera's and a zooming lens' included, is an affine map from the picture space of one time to
// another's.
#ifndef SHUTTER_INSTANT_MOTION_SHARED_H
#define SHUTTER_INSTANT_MOTION_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// One mover at one instant: rows of 3x4 matrices. All 0: it is nowhere to be seen at the instant.
struct InstantMotion {
    vec4 rasterFromInstant[3];
    vec4 instantFromRaster[3];
};

/// What one raster holds of the exposure.
struct LayerMotion {
    uvec2 movers; // address of uint[]: by row of the raster's entity table, and one for the sky
    /// Address of InstantMotion[]: for each mover one per instant; with a lens one per sample, of
    /// the pinhole in its middle.
    uvec2 motions;
    uint rowCount; // of the entity table
    uint isStatic; // 1: static entities have the same place in the picture at all instants, as in
                   // the raster
    /// Address of float[]: by row of the entity table, how far a surface moves within the exposure
    /// relative to one infinitely far away, times its depth (pixels * metres), or per depth (pixels
    /// / metre) before an orthographic camera. The greatest in the picture; 0: depth makes no
    /// difference, or it is not rigid.
    uvec2 parallaxes;
};

/// Where the places of the lens lie that the sets take a sample at: they move what a pinhole in its
/// middle sees at depth z by low to high, times 1 / z - inverseFocus, pixels.
struct LensReach {
    vec2 low;
    vec2 high;
    float inverseFocus; // 1/metre
    float radius;       // of the lens, pixels by which it moves what is 1 / z - inverseFocus = 1
    float padding1;
    float padding2;
};

/// What a frame's rasters and the one of the frame before hold.
struct InstantMotions {
    LayerMotion raster;
    LayerMotion second; // of the exposure's other end
    LayerMotion last;
    // Addresses of uint[]: by row of that raster's entity table, the same entity's row in this
    // frame's, or kNoRasterRow.
    uvec2 secondRows;
    uvec2 lastRows;
    uvec2 times; // address of float[]: shutter time of each instant
    // Address of vec4[]: displacement in the picture by each instant's place of the lens, pixels. A
    // point at depth z is displaced by xy + zw / z from its place for a pinhole at the lens's
    // centre. 0: there is no lens.
    uvec2 lens;
    // Lens at the raster's time: depth z has a circle of confusion of diameter 2 |x - y / z|,
    // pixels.
    vec2 confusion;
    uint isPerspective; // 1: the camera is; 0: orthographic
    uint padding0;
    // Address of LensReach[]: one per sample, and one of all, with the focus of the one in the
    // middle. 0: there is no lens.
    uvec2 lensReaches;
    // Address of vec2[]: each instant's place of the lens, metres right and up in the picture. 0:
    // there is no lens.
    uvec2 lensPlaces;
    vec4 aperture; // Aperture's fields (common/aperture.glsl); with a lens
};

/// In the table of movers, by row of the raster's entity table; the sky follows the last row.
SHUTTER_CONST uint kWorldMover = 0u; // is static in the world
SHUTTER_CONST uint kSkyMover = 1u;
/// Its shape changes: its pixels' motion vectors give its motion.
SHUTTER_CONST uint kDeformedMover = 0xFFFFFFFEu;
/// Its pixels in the raster are not used for the exposure.
SHUTTER_CONST uint kNoMover = 0xFFFFFFFFu;

/// Sets of instants with a lens, which pixels take turns in: one for each of 4 x 4. They have a
/// sample at the same time, from places of their own.
SHUTTER_CONST uint kLensSets = 16u;
/// The one of them that lies evenly about the lens's middle.
SHUTTER_CONST uint kMiddleLensSet = 1u;

/// The entity is not among this frame's rows, or it is not known which one it is.
SHUTTER_CONST uint kNoRasterRow = 0xFFFFFFFFu;

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::InstantMotion) == 96);
static_assert(sizeof(shutter::shader::LayerMotion) == 32);
static_assert(sizeof(shutter::shader::LensReach) == 32);
static_assert(sizeof(shutter::shader::InstantMotions) == 176);
#endif

#endif
