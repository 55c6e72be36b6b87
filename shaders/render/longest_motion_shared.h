// SPDX-License-Identifier: MIT
#ifndef SHUTTER_LONGEST_MOTION_SHARED_H
#define SHUTTER_LONGEST_MOTION_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kLongestMotionGroup = 8u; // threads to each side of a group

struct LongestMotionParams {
    uvec2 sizePx;
    uint rowCount; // of the entity table; pixels of no row count for one more, the sky
    uint padding0;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::LongestMotionParams) == 16);
#endif

#endif
