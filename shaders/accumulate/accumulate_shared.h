// SPDX-License-Identifier: MIT
#ifndef SHUTTER_ACCUMULATE_SHARED_H
#define SHUTTER_ACCUMULATE_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

struct AccumulateParams {
    uvec2 sizePx;
    uint clears;  // 1: the sum starts with this frame
    float weight; // of this frame
    float scale;  // factor of the resulting sum: 1, or at the last frame 1 / count, which gives the
                  // mean
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::AccumulateParams) == 20);
#endif

#endif
