// SPDX-License-Identifier: MIT
#ifndef SHUTTER_TAA_SHARED_H
#define SHUTTER_TAA_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Places in the pixel, one per frame in turn: as many as a settled picture has samples.
SHUTTER_CONST uint kPlaceCount = 16u;

// States of a row of the entity table.
SHUTTER_CONST uint kMovingRow = 0u; // the entity moves, or has moved since the last frame
SHUTTER_CONST uint kStaticRow = 1u;
SHUTTER_CONST uint kNewRow =
    2u; // it does not move now, and did until the last frame or was not there

/// Bit of a pixel of the static rows: its colour may be out of date.
SHUTTER_CONST uint kDoubted = 0x80000000u;

/// Which entities are static.
struct StaticRows {
    uvec2 states;  // address of uint[]: k...Row by row of this frame's entity table, then the sky's
    uvec2 nowRows; // address of uint[]: this frame's row by row of the last one's, if the entity
                   // has been static since then, else 0xFFFFFFFF; then the sky's
    uint rowCount; // of this frame
    uint lastCount; // of the last one
};

struct TaaParams {
    uvec2 sizePx;
    vec2 jitterPx; // of this frame's static samples: right and down, in its pixels
    uvec2 frame;   // address of FrameConstants
    StaticRows rows;
    uint hasLast;   // 1: colours were kept
    uint mayDiffer; // 1: static surfaces may differ from the last frame
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::StaticRows) == 24);
static_assert(sizeof(shutter::shader::TaaParams) == 56);
#endif

#endif
