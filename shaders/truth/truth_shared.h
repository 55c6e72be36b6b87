// SPDX-License-Identifier: MIT
#ifndef SHUTTER_TRUTH_SHARED_H
#define SHUTTER_TRUTH_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kTruthGroupSize = 8u; // 8 x 8 threads

struct TruthParams {
    uvec2 sizePx;
    uvec2 frame;   // address of FrameConstants
    uvec2 moving;  // address of TimedConstants
    uint firstRay; // rays per pixel before this batch; 0 clears
    uint rayCount; // rays per pixel of this batch
    uint seed;
    uint boxFilter; // 1: anywhere in the pixel, 0: its centre
    uvec2 response; // address of the shutter's ResponseTable; 0: a box
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::TruthParams) == 48);
#endif

#endif
