// SPDX-License-Identifier: MIT
// Deforming parts: the pixels of one entity in one tile of a layer, all of them or one of two
// halves that move differently. A part's per-pixel motion (common/pixel_way.glsl) is fitted by
// affine maps, which give first guesses; per-pixel motion then determines the sample.
#ifndef SHUTTER_RESOLVED_PARTS_SHARED_H
#define SHUTTER_RESOLVED_PARTS_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Most parts of a tile, of all its entities. If there are fewer, one with kNoKey follows them.
SHUTTER_CONST uint kPartsPerTile = 8u;
/// Of Candidate::key: the other bits are the index of a TilePart.
SHUTTER_CONST uint kPartBit = 0x80000000u;

/// One of PixelWay's three vectors as an affine map of the place.
struct PartVector {
    vec2 shift;   // at the part's centre, pixels
    uvec2 change; // per pixel, as halves: of x by x and y, of y by x and y
};

struct TilePart {
    uint key; // of the entity; from bit kPartWidthShift on the box's width, from kPartHeightShift
              // on its height, both less one
    uint corner;      // least pixel of the box: x | y << 16
    vec2 centre;      // mean of its pixels' centres
    uvec2 deviations; // greatest, of a pixel from the fits, pixels: halves, open and close; bend
    PartVector open;
    PartVector close;
    PartVector bend;
};

SHUTTER_CONST uint kPartWidthShift = 24u;
SHUTTER_CONST uint kPartHeightShift = 28u;

/// Head of the list of tiles in which something deforms; the tiles follow, x | y << 16.
struct DeformingHeader {
    uint count;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::PartVector) == 16);
static_assert(sizeof(shutter::shader::TilePart) == 72);
static_assert(sizeof(shutter::shader::DeformingHeader) == 4);
#endif

#endif
