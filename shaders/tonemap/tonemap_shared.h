// SPDX-License-Identifier: MIT
#ifndef SHUTTER_TONEMAP_SHARED_H
#define SHUTTER_TONEMAP_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kTonemapGroup = 8u; // side, pixels

SHUTTER_CONST uint kTonemapNone = 0u;    // clamp to [0, 1]
SHUTTER_CONST uint kTonemapNeutral = 1u; // Khronos PBR Neutral

struct TonemapParams {
    uvec2 sizePx;
    float gain; // linear multiplier before the operator: 2^EV
    uint operator_;
    uvec2 brightest; // address of float[]: by group, row by row; 0: not requested
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::TonemapParams) == 24);
#endif

#endif
