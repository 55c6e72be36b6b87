// SPDX-License-Identifier: MIT
// Interface between the motion blur's passes and their shaders.
#ifndef SHUTTER_MOTION_BLUR_SHARED_H
#define SHUTTER_MOTION_BLUR_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kGroupSize = 8u;      // pixel passes: 8 x 8 threads, a block
SHUTTER_CONST uint kTileColumns = 8u;    // tile max: threads in a row; a multiple of it in a group
SHUTTER_CONST uint kRevealThreads = 64u; // reveal: masked pixels a group

/// Motion shorter than this blurs less than a pixel shows: such pixels are still.
SHUTTER_CONST float kStillPx = 0.5f;

/// What every pass reads: the first half of the push constants. The second half is the method's own
/// block (gather_shared.h, hybrid_shared.h, ...).
struct MotionBlurParams {
    uvec2 sizePx;
    uvec2 tileCount;
    uint tileSizePx;
    int neighbourRadius; // tiles to each side
    uint sampleCount;
    float softDepthExtent; // metres, of softExtent() (weights.glsl)
    float rasterTime;      // of the exposure, [0, 1]
    float jitter;          // of the taps, share of their distance, [0, 1]
    float maxMotionDepth;  // metres; deeper pixels count as still; infinity: none do
    float marginPx;        // beyond a block whose tiles its pixels may look up
    uvec2 response;        // address of the shutter's ResponseTable; 0: a box
    float uniformMotionPx; // deviation that still counts as uniform motion; 0: none does
    float softDepthShare;  // of the depth, of softExtent()
};

// Work goes by blocks of kGroupSize x kGroupSize pixels, one group each; passes after the
// classification are dispatched over compacted lists of them. Four lists share a buffer.
SHUTTER_CONST uint kUniformList = 0u; // all motion around is the dominant one
SHUTTER_CONST uint kMixedList = 1u;   // no masked pixel in it, or no mask was requested
SHUTTER_CONST uint kMaskedList = 2u;  // masked pixels in it
SHUTTER_CONST uint kStillList = 3u;   // nothing that moves reaches it; where it is wanted
SHUTTER_CONST uint kListCount = 4u;
/// In the other buffer of the mask's passes: mixed blocks that may have masked pixels.
SHUTTER_CONST uint kCandidateList = 0u;

/// Groups in x of a dispatch over a list; further ones go to y, so that no picture has more than a
/// device takes (65535 in each).
SHUTTER_CONST uint kListRow = 256u;

/// VkDispatchIndirectCommand.
struct DispatchArguments {
    uint groupsX;
    uint groupsY;
    uint groupsZ;
};

/// Head of a buffer of lists; room for every block of the picture follows for each list. An entry
/// is x | y << 16, in blocks.
struct BlockHeader {
    uint uniformCount;
    uint mixedCount;
    uint maskedCount;
    uint stillCount;
};

/// Head of the list of tiles with masked pixels; the tiles (x | y << 16) follow, as many as there
/// are, then for each tile of the picture 1 where it is in the list.
struct TileHeader {
    uint count;
    uint padding0;
    uint padding1;
    uint padding2;
};

/// In an entry of the list of masked pixels: the revealed background is used for all masked pixels
/// of its quad, of which it is the first. Pictures are at most 32768 pixels high.
SHUTTER_CONST uint kQuadFlag = 0x80000000u;

/// Head of the list of masked pixels; the pixels (x | y << 16) follow.
struct MaskHeader {
    uint listedPixels;
    uint extraRays;     // of the listed pixels, nearly all of which trace one
    uint sharingPixels; // masked, but in no list: they share a ray of their quad
    uint raylessPixels; // listed, but they traced none
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::MotionBlurParams) == 64);
static_assert(sizeof(shutter::shader::DispatchArguments) == 12);
static_assert(sizeof(shutter::shader::BlockHeader) == 16);
static_assert(sizeof(shutter::shader::TileHeader) == 16);
static_assert(sizeof(shutter::shader::MaskHeader) == 16);
#endif

#endif
