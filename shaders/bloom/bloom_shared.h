// SPDX-License-Identifier: MIT
#ifndef SHUTTER_BLOOM_SHARED_H
#define SHUTTER_BLOOM_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

struct BloomParams {
    uvec2 sizePx;    // of the image that is written
    uvec2 sourcePx;  // of the one that is filtered: the finer one on the way down, the coarser up
    float share;     // up: weight of the coarser image in the output
    float threshold; // of the scattered light of the finer image; 0: all of it
    float knee;      // of the threshold, in its unit
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::BloomParams) == 28);
#endif

#endif
