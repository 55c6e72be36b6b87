// SPDX-License-Identifier: MIT
#ifndef SHUTTER_ACCUMULATE_SHARED_H
#define SHUTTER_ACCUMULATE_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

struct AccumulateParams {
    uvec2 sizePx;
    uint index;  // of this instant, 0 clears
    float scale; // 1 / instants at the last one, which turns the sum into the mean; else 1
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::AccumulateParams) == 16);
#endif

#endif
